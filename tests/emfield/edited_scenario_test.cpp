// A solver that is given edited scenarios recomputes what an edit invalidates; the result is bit-identical to
// that of a new solver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/emfield/edited_battlefield.h"
#include "tests/emfield/made_terrain.h"
#include "tests/support/errors.h"
#include "tests/support/gpu.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::CombineMode;
using ::testing::HasSubstr;

/// One kind of edit, named by the key that it changes. Solvers may refuse the result.
using Edit = std::pair<const char*, std::function<void(Scenario&, Emitter&, Random&)>>;

/// An edit of a scenario `s` or its emitter `e` that draws one of several values, or a number between two.
#define CHOICE(value, ...)                                                                \
  Edit(#value, []([[maybe_unused]] Scenario& s, [[maybe_unused]] Emitter& e, Random& r) { \
    using Value [[maybe_unused]] = decltype(value);                                       \
    value = oneOf(r, std::vector<decltype(value)>{__VA_ARGS__});                          \
  })
#define NUMBER(value, low, high)                                                          \
  Edit(#value, []([[maybe_unused]] Scenario& s, [[maybe_unused]] Emitter& e, Random& r) { \
    value = between(r, low, high);                                                        \
  })

const std::vector<Edit>& emitterEdits() {
  using propagation::Polarization;
  static const std::vector<Edit> edits{
      {"name", [](Scenario&, Emitter& e, Random&) { e.name += "'"; }},
      NUMBER(e.power_w, 1, 1e5),
      NUMBER(e.losses_db, 0, 5),
      CHOICE(e.frequency_hz, 4e8, 1.2e9, 3e9, 9e9),
      NUMBER(e.bandwidth_hz, 0, 3e7),
      CHOICE(e.polarization, Value::horizontal, Value::vertical, Value::slant_45, Value::circular_left),
      {"antenna", [](Scenario&, Emitter& e, Random& r) { e.antenna = someAntenna(r); }},
      {"scan.kind",
       [](Scenario&, Emitter& e, Random& r) {
         e.scan.kind = oneOf(r, std::vector{scenario::ScanKind::fixed, scenario::ScanKind::rotate,
                                            scenario::ScanKind::sector});
         e.scan.rate_rpm = 7;
         e.scan.width_deg = 80;
         e.scan.rate_deg_s = 20;
       }},
      NUMBER(e.scan.azimuth_deg, 0, 360),
      NUMBER(e.scan.elevation_deg, -5, 20),
      CHOICE(e.propagation.model, Value::free_space, Value::horizon, Value::diffraction, Value::two_ray,
             Value::itm, Value::p528, Value::p1812, Value::p452),
      CHOICE(e.propagation.diffraction.method, Value::delta_bullington, Value::single_edge, Value::deygout),
      CHOICE(e.propagation.two_ray.sum, Value::coherent, Value::envelope),
      CHOICE(e.propagation.two_ray.roughness_model, Value::ament, Value::miller_brown),
      CHOICE(e.propagation.itm.form, Value::point_to_point, Value::area),
      NUMBER(e.propagation.itm.time_percent, 5, 95),
      NUMBER(e.propagation.itm.location_percent, 5, 95),
      NUMBER(e.propagation.itm.situation_percent, 5, 95),
      CHOICE(e.propagation.itm.service, Value::single_message, Value::mobile, Value::broadcast),
      NUMBER(e.propagation.itm.irregularity_m, 10, 300),
      {"itm.siting",
       [](Scenario&, Emitter& e, Random& r) {
         e.propagation.itm.transmitter_siting =
             oneOf(r, std::vector{propagation::ItmSiting::random, propagation::ItmSiting::careful});
         e.propagation.itm.receiver_siting =
             oneOf(r, std::vector{propagation::ItmSiting::random, propagation::ItmSiting::very_careful});
       }},
      NUMBER(e.propagation.p528.time_percent, 0, 99),
      NUMBER(e.propagation.p1812.time_percent, 1, 50),
      NUMBER(e.propagation.p1812.location_percent, 1, 99),
      NUMBER(e.propagation.p1812.clutter_height_m, 0, 30),
      CHOICE(e.propagation.p1812.zone, Value::by_height, Value::inland, Value::sea),
      NUMBER(e.propagation.p452.time_percent, 0.01, 50),
      NUMBER(e.propagation.p452.refractivity_lapse_rate, 20, 80),
      NUMBER(e.receiver.noise_figure_db, 1, 9),
      NUMBER(e.receiver.antenna_temperature_k, 50, 400),
      NUMBER(e.receiver.bandwidth_hz, 1e5, 1e7),
      NUMBER(e.receiver.losses_db, 0, 4),
      NUMBER(e.receiver.processing_gain_db, 0, 30),
      CHOICE(e.receiver.polarization, Polarization::horizontal, Polarization::circular_right),
      NUMBER(e.receiver.cross_polar_isolation_db, 15, 40),
      {"receiver.pulses", [](Scenario&, Emitter& e, Random& r) { e.receiver.pulses = 1 + below(r, 30); }},
      CHOICE(e.receiver.pfa, 1e-8, 1e-4),
      {"receiver.swerling", [](Scenario&, Emitter& e, Random& r) { e.receiver.swerling = below(r, 5); }},
      CHOICE(e.receiver.detection, Value::exact, Value::shnidman),
      NUMBER(e.receiver.required_signal_to_jammer_db, 3, 20),
      NUMBER(e.receiver.target_rcs_m2, 0.1, 20),
      {"active_s",
       [](Scenario&, Emitter& e, Random& r) {
         e.active_s = below(r, 2) == 0 ? std::vector<scenario::TimeInterval>{}
                                       : std::vector<scenario::TimeInterval>{{between(r, 0, 3), 9}};
       }},
      {"kind",
       [](Scenario& s, Emitter& e, Random& r) {
         if (&e == &s.emitters.front()) return;  // some quantities need a radar
         e.kind = oneOf(r, std::vector{EmitterKind::radar, EmitterKind::transmitter, EmitterKind::jammer});
       }},
      {"position",
       [](Scenario& s, Emitter& e, Random& r) {
         auto& at = s.platforms[static_cast<std::size_t>(e.platform)].track.front().position;
         const GeodeticPosition to = somewhere(r);
         at.latitude_deg = to.latitude_deg;
         at.longitude_deg = to.longitude_deg;
         at.height_ellipsoid_m = to.height_ellipsoid_m;
       }},
      {"position, by a centimetre",
       [](Scenario& s, Emitter& e, Random&) {
         *s.platforms[static_cast<std::size_t>(e.platform)].track.front().position.height_ellipsoid_m += 0.01;
       }},
      {"heading_deg",
       [](Scenario& s, Emitter& e, Random& r) {
         s.platforms[static_cast<std::size_t>(e.platform)].attitude.heading_deg = between(r, 0, 360);
       }},
      {"name", [](Scenario&, Emitter& e, Random&) { e.name += "'"; }},
  };
  return edits;
}

const std::vector<Edit>& scenarioEdits() {
  static const std::vector<Edit> edits{
      NUMBER(s.atmosphere.k_factor, 1, 1.6),
      NUMBER(s.atmosphere.pressure_hpa, 950, 1040),
      NUMBER(s.atmosphere.temperature_k, 260, 310),
      NUMBER(s.atmosphere.vapour_g_m3, 0, 20),
      CHOICE(s.atmosphere.rain_mm_h, 0., 5., 30.),
      NUMBER(s.atmosphere.rain_height_m, 500, 4000),
      CHOICE(s.atmosphere.gases, Value::automatic, Value::always, Value::never),
      NUMBER(s.atmosphere.sea_level_refractivity, 260, 380),
      CHOICE(s.atmosphere.climate, Value::desert, Value::equatorial),
      CHOICE(s.ground.kind, Value::sea, Value::dry_ground),
      NUMBER(s.ground.relative_permittivity, 4, 60),
      NUMBER(s.ground.conductivity_s_m, 0.001, 4),
      NUMBER(s.ground.roughness_m, 0, 2),
      NUMBER(s.ground.surface_msl_m, 0, 900),
      {"region.dims",
       [](Scenario& s, Emitter&, Random& r) {
         s.region.dims = {10 + below(r, 4), 9 + below(r, 4), 4 + below(r, 3)};
       }},
      NUMBER(s.region.size_m.x, 12e3, 18e3),
      NUMBER(s.region.origin.height_msl_m, 0, 500),
      {"receivers",
       [](Scenario& s, Emitter&, Random& r) {
         s.receivers.front().gain_dbi = between(r, 0, 9);
         s.receivers.front().polarization = propagation::Polarization::vertical;
         s.receivers.front().bandwidth_hz = between(r, 1e5, 1e8);
       }},
      NUMBER(s.bands.front().end_hz, 1e9, 5e9),
      {"output.quantities",
       [](Scenario& s, Emitter&, Random& r) {
         s.output.quantities = oneOf(r, std::vector<std::vector<std::string>>{
                                            {"power_density_dbwm2", "snr_db"},
                                            {"detection_probability", "jammer_to_signal_db"},
                                            {"received_power_dbm", "emitter_count", "dominant_emitter"},
                                            {"sinr_db", "intercept_margin_db"},
                                            {"burn_through_margin_db", "field_strength_dbuvm"}});
       }},
      CHOICE(s.output.combine, Value::sum, Value::max, Value::per_emitter, Value::per_band),
      CHOICE(s.output.radar_look, Value::scan, Value::target),
      {"output.wanted_emitter",
       [](Scenario& s, Emitter&, Random& r) { s.output.wanted_emitter = below(r, 3); }},
      NUMBER(s.output.floor, -200, -60),
      NUMBER(s.output.count_threshold_dbwm2, -90, -40),
      {"name", [](Scenario& s, Emitter&, Random&) { s.hash = (s.name += "'"); }},
      {"emitters: one more",
       [](Scenario& s, Emitter&, Random& r) {
         if (s.emitters.size() < 7) addEmitter(s, somewhere(r), plainEmitter("new", 0));
         s.emitters.back().name += std::to_string(s.emitters.size());
       }},
      {"emitters: one less",
       [](Scenario& s, Emitter&, Random&) {
         if (s.emitters.size() > 3) s.emitters.pop_back();
       }},
      {"emitters: another order",
       [](Scenario& s, Emitter&, Random&) { std::swap(s.emitters[1], s.emitters.back()); }},
  };
  return edits;
}

/// Edits values of a copy. @return the key that was edited
std::string editValue(Scenario& scenario, Random& random) {
  const auto& edits = below(random, 5) < 3 ? emitterEdits() : scenarioEdits();
  const Edit& edit = edits[static_cast<std::size_t>(below(random, edits.size()))];
  edit.second(scenario, scenario.emitters[static_cast<std::size_t>(below(random, scenario.emitters.size()))],
              random);
  return edit.first;
}

/// Makes an edited scenario of another one. @return description of the edit
using Editor = std::function<std::string(Scenario&, Random&)>;

/// Gives a solver one edit after the other, and compares each result with that of a new solver. Edits that a
/// new solver refuses must also be refused by the update, and leave the solver unchanged.
void checkEdits(std::shared_ptr<const Scenario> scenario, std::vector<scenario::TerrainPtr> terrains,
                int count, const Editor& edit, Random& random, const FieldOptions& options = {}) {
  scenario::TerrainPtr terrain = terrains.front();
  FieldSolver solver(scenario, terrain, options);
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0), terrain);
  int compared = 0;
  for (int n = 0; n < count; ++n) {
    auto edited = std::make_shared<Scenario>(*scenario);
    SCOPED_TRACE(::testing::Message() << "edit " << n << ": " << edit(*edited, random));
    const scenario::TerrainPtr ground = below(random, 12) == 0 ? oneOf(random, terrains) : terrain;
    const double t_s = oneOf(random, std::vector{0., 0., 2., 3.5});
    std::unique_ptr<FieldSolver> fresh;
    scenario::Snapshot snapshot;
    try {
      snapshot = scenario::snapshotAt(edited, ground.get(), t_s);
    } catch (const Error&) {
      continue;  // below the ground: refused before a solver gets it
    }
    try {
      fresh = std::make_unique<FieldSolver>(edited, ground, options);
      fresh->update(snapshot);
    } catch (const Error& error) {
      const volume::Volume before = solver.volumes().front();
      try {
        solver.update(snapshot, ground);
        ADD_FAILURE() << "not refused: " << error.what();
      } catch (const Error& of_update) {
        EXPECT_STREQ(of_update.what(), error.what());
      }
      EXPECT_EQ(solver.volumes().front().dense(), before.dense());
      EXPECT_EQ(solver.volumes().front().device(), before.device());
      continue;
    }
    solver.update(snapshot, ground);
    expectEqualSolvers(solver, *fresh);
    if (::testing::Test::HasFailure()) return;
    ++compared;
    scenario = edited;
    terrain = ground;
  }
  EXPECT_GT(compared, count * 3 / 4) << "too many edits were refused";
}

std::vector<scenario::TerrainPtr> hills() {
  return {std::make_shared<MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.4),
          std::make_shared<MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.5)};
}

TEST(EditedScenario, EqualsANewSolverWithoutTerrain) {
  Random random(1);
  checkEdits(
      battlefield(random, FrameKind::altitude,
                  {PropagationModel::free_space, PropagationModel::horizon, PropagationModel::two_ray}),
      {nullptr}, 80, editValue, random);
}

TEST(EditedScenario, SLOW_EqualsANewSolverOverTerrainInAllModels) {
  Random random(2);
  checkEdits(battlefield(random, FrameKind::altitude,
                         {PropagationModel::diffraction, PropagationModel::horizon, PropagationModel::itm,
                          PropagationModel::p528, PropagationModel::two_ray, PropagationModel::p1812,
                          PropagationModel::p452}),
             hills(), 50, editValue, random);
}

TEST(EditedScenario, SLOW_EqualsNewSolverInTiltedFrame) {
  Random random(3);
  checkEdits(battlefield(random, FrameKind::enu, {PropagationModel::diffraction, PropagationModel::horizon}),
             hills(), 40, editValue, random);
}

TEST(EditedScenario, EqualsANewSolverWhereRadarsAreJammed) {
  Random random(4);
  auto scenario = battlefield(random, FrameKind::altitude, {PropagationModel::horizon});
  scenario->output.quantities = {"detection_probability", "jammer_to_signal_db", "burn_through_margin_db"};
  scenario->output.radar_look = scenario::RadarAim::target;
  checkEdits(scenario, hills(), 60, editValue, random);
}

TEST(EditedScenario, EqualsANewSolverForOneVolumePerEmitterOrBand) {
  Random random(5);
  for (const CombineMode combine : {CombineMode::per_emitter, CombineMode::per_band}) {
    auto scenario = battlefield(random, FrameKind::altitude, {PropagationModel::horizon});
    scenario->output.combine = combine;
    scenario->output.quantities = {"power_density_dbwm2", "snr_db"};
    checkEdits(scenario, {nullptr}, 40, editValue, random);
  }
}

TEST(EditedScenario, EqualsANewSolverWithABoundOnTheCaches) {
  Random random(6);
  FieldOptions options;
  options.cache_bytes = 12 * 11 * 40 * 3 + 1;
  checkEdits(
      battlefield(random, FrameKind::altitude, {PropagationModel::free_space, PropagationModel::horizon}),
      {nullptr}, 40, editValue, random, options);
}

/// Edits that only recompute echoes, followed by one that requires the sum over all emitters again.
class EditedEchoes : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(EditedEchoes);

TEST_P(EditedEchoes, ThenPowerEqualANewSolver) {
  FieldOptions options;
  options.backend = GetParam();
  options.also_unjammed = true;
  Random random(9);
  auto scenario = battlefield(random, FrameKind::altitude, {PropagationModel::horizon});
  scenario->output.quantities = {"power_density_dbwm2", "detection_probability"};
  scenario->output.radar_look = scenario::RadarAim::target;
  SolvedField solver(scenario, nullptr, options);
  const auto edit = [&](const std::function<void(Scenario&)>& change) {
    scenario = std::make_shared<Scenario>(*scenario);
    change(*scenario);
    solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  };
  for (int n = 0; n < 3; ++n) {
    edit([](Scenario& s) {
      for (Emitter& emitter : s.emitters) emitter.receiver.target_rcs_m2 *= 2;
    });
  }
  for (int n = 0; n < 3; ++n) edit([](Scenario& s) { s.emitters.back().power_w *= 2; });
  SolvedField fresh(scenario, nullptr, options);
  expectEqualSolvers(solver, fresh);
}

TEST(CudaEditedScenario, EqualsANewSolver) {
  EMSCAPE_NEEDS_GPU();
  Random random(8);
  FieldOptions options;
  options.backend = Backend::cuda;
  checkEdits(
      battlefield(random, FrameKind::altitude,
                  {PropagationModel::diffraction, PropagationModel::horizon, PropagationModel::two_ray}),
      hills(), 80, editValue, random, options);
  auto jammed = battlefield(random, FrameKind::altitude, {PropagationModel::horizon});
  jammed->output.quantities = {"detection_probability", "jammer_to_signal_db", "burn_through_margin_db"};
  checkEdits(jammed, hills(), 60, editValue, random, options);
}

TEST(EditedScenario, AnUpdateThatFailsOverAHoleCanBeFollowedByOthers) {
  Random random(8);
  const auto terrain = std::make_shared<MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.5, 0.02);
  auto scenario = battlefield(random, FrameKind::altitude, {PropagationModel::free_space});
  scenario->region.size_m = {9e3, 9e3, 4000};
  SolvedField solver(scenario, terrain);
  auto edited = std::make_shared<Scenario>(*scenario);
  edited->emitters[3].propagation.model = PropagationModel::diffraction;
  edited->platforms[3].track.front().position.latitude_deg = kLatitude_deg + 0.24;
  edited->platforms[3].track.front().position.longitude_deg = kLongitude_deg + 0.24;
  const Error error = test::thrownBy([&] { solver.update(scenario::snapshotAt(edited, terrain.get(), 0)); });
  EXPECT_EQ(error.hint(), Hint::allow_missing_terrain);  // the path crosses the hole
  EXPECT_THAT(error.what(), HasSubstr("emitter 'radio': the path to latitude"));
  const auto moved = std::make_shared<Scenario>(*scenario);
  moved->emitters[0].power_w = 5;
  solver.update(scenario::snapshotAt(moved, terrain.get(), 2));
  SolvedField fresh(moved, terrain, {}, 2);
  expectEqualSolvers(solver, fresh);
}

}  // namespace
}  // namespace emscape::emfield
