// The reflected ray of `two_ray`, weighted by the antennas' patterns.
#include "emfield/columns/two_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emfield/columns/station.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "propagation/inputs.h"
#include "propagation/two_ray/two_ray.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/files.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;

TEST(ReflectedRayCode, DecodesWithinOneStep) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(0, 1);
  for (int n = 0; n < 10000; ++n) {
    ReflectedRay ray{2 * part(random) - 1, 2 * part(random) - 1, part(random), part(random), n % 2 == 0};
    if (n == 0) ray = {-1, 0, 1, 1, false};
    if (n == 1) ray = {1, -1, 0, 0, true};
    const ReflectedRay read = reflectedRay(reflectedRayCode(ray));
    EXPECT_EQ(read.re, ray.re);
    EXPECT_EQ(read.im, ray.im);
    EXPECT_NEAR(read.weight, ray.weight, 3.1e-5f);
    EXPECT_EQ(read.depression_sine, ray.depression_sine);
    EXPECT_EQ(read.is_envelope, ray.is_envelope);
  }
  EXPECT_EQ(reflectedRay(reflectedRayCode({0, 0, 1, 0, false})).weight, 1) << "exactly";
  EXPECT_EQ(powerOfBothRays(reflectedRay({}), 0.3f, 0.7f), 0.3f * 0.3f) << "the default is no reflected ray";
}

TEST(PowerOfBothRays, IsSumOfAmplitudesRelativeToIsotropicAntennas) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const double re = 0.7 * part(random), im = 0.7 * std::abs(part(random)), q = std::abs(part(random));
    const double d = part(random), r = part(random);
    ReflectedRay ray{float(re), float(im), 1, 0, false};
    const double both = std::hypot(d + r * re, r * im), isotropic = std::hypot(1 + re, im);
    EXPECT_NEAR(powerOfBothRays(ray, float(d), float(r)), std::pow(both / isotropic, 2), 1e-4);
    EXPECT_NEAR(powerOfBothRays(ray, 1, 1), 1, 1e-6) << "the excess holds the rest";
    EXPECT_NEAR(powerOfBothRays(ray, float(d), 0), d * d / (isotropic * isotropic), 1e-4);
    ray.weight = float(q);
    if (both > 1e-3 * std::abs(d)) {
      EXPECT_NEAR(powerOfBothRays(ray, float(d), float(r)),
                  d * d * std::pow(both / (isotropic * std::abs(d)), 2 * q), 1e-3);
    }
    ray = {float(std::hypot(re, im)), 0, 1, 0, true};
    const double larger = (std::abs(d) + std::abs(r) * double(ray.re)) / (1 + double(ray.re));
    EXPECT_NEAR(powerOfBothRays(ray, float(d), float(r)), larger * larger, 1e-5) << "the lobes' tops";
  }
}

TEST(PowerOfBothRays, StaysFiniteInNulls) {
  const ReflectedRay null{-1, 0, 1, 0.1f, false};
  EXPECT_EQ(powerOfBothRays(null, 1, 1), 1) << "the excess is bounded at 60 dB";
  EXPECT_NEAR(powerOfBothRays(null, 1, 0.01f), 0.99f * 0.99f * 1e6f, 1e3f) << "it has no null";
  EXPECT_NEAR(powerOfBothRays({0.5f, 0, 1, 0, false}, 0.5f, -1), 0.25f * 1e-6f / 2.25f, 1e-12f);
  for (const float weight : {0.0f, 0.5f, 1.0f}) {
    EXPECT_EQ(powerOfBothRays({0.5f, 0, weight, 0, false}, 0, 0), 0);
    EXPECT_TRUE(std::isfinite(powerOfBothRays({0.5f, 0, weight, 0, false}, 0, 1)));
  }
}

TEST(ReflectedDirection, LiesInThePlaneOfTheDirectRay) {
  const Vec3f below = reflectedDirection({300, -400, 77}, 0.6f);
  EXPECT_NEAR(below.x, 0.8 * 0.6, 1e-6);
  EXPECT_NEAR(below.y, -0.8 * 0.8, 1e-6);
  EXPECT_NEAR(below.z, -0.6, 1e-6);
  EXPECT_EQ(reflectedDirection({0, 0, 5}, 1).z, -1) << "straight below";
}

constexpr double kShip_msl_m = 20;
constexpr GeodeticPosition kShip{52, 5, 0};

/// The point on a parallel at a distance east of the ship.
GeodeticPosition eastOfShip(double range_m) {
  const GeodeticPosition there = geodesicDirect(kShip.latitude_deg, kShip.longitude_deg, kPi / 2, range_m);
  return {there.latitude_deg, there.longitude_deg, 0};
}

void placeOver(scenario::Scenario& scenario, scenario::Emitter emitter, const GeodeticPosition& position,
               double height_msl_m) {
  addEmitter(scenario, position, std::move(emitter));
  scenario::TrackPoint& point = scenario.platforms.back().track[0];
  point.position.height_ellipsoid_m.reset();
  point.position.height_msl_m = height_msl_m;
}

/// Voxels over the sea, in clear air, around a point at a distance east of the ship.
std::shared_ptr<scenario::Scenario> overTheSea(double range_m, double lowest_m, Vec3d size_m, Dims dims) {
  const GeodeticPosition middle = eastOfShip(range_m);
  auto scenario = emptyScenario(FrameKind::altitude, middle.latitude_deg, middle.longitude_deg, size_m, dims);
  scenario->region.origin.height_msl_m = lowest_m;
  scenario->atmosphere.gases = propagation::GasLosses::never;
  scenario->ground.kind = propagation::GroundKind::sea;
  return scenario;
}

/// A radar with the beam 2 degrees wide, 10 degrees up towards the east.
scenario::Emitter beamUpwards() {
  scenario::Emitter radar = radarOf(scenario::makeGaussian(kGain_dbi, 2, 2, -40));
  radar.scan.kind = scenario::ScanKind::track;
  radar.scan.azimuth_deg = 90;
  radar.scan.elevation_deg = 10;
  radar.propagation.model = PropagationModel::two_ray;
  return radar;
}

class TwoRays : public test::OnBackends {
 protected:
  static FieldOptions options() {
    FieldOptions options;
    options.backend = GetParam();
    return options;
  }
  /// The first channel's volume.
  static std::shared_ptr<const volume::DenseVolume> field(
      const std::shared_ptr<scenario::Scenario>& scenario) {
    return solve(scenario, nullptr, options());
  }
  /// Largest minus smallest difference (dB) between a scenario's volume by two_ray and in free space.
  static double ripple_db(const std::shared_ptr<scenario::Scenario>& scenario) {
    scenario->emitters[0].propagation.model = PropagationModel::two_ray;
    const auto lobes = field(scenario);
    scenario->emitters[0].propagation.model = PropagationModel::free_space;
    const auto free = field(scenario);
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t v = 0; v < lobes->values.size(); ++v) {
      const double apart = static_cast<double>(lobes->values[v]) - static_cast<double>(free->values[v]);
      lowest = std::min(lowest, apart);
      highest = std::max(highest, apart);
    }
    return highest - lowest;
  }
};

TEST_P(TwoRays, BeamAboveTheSeaHasNoLobes) {
  // 3 km off the direct ray leaves 9.5 to 10.6 degrees upwards, the reflected one as far downwards, at -40 dB
  // of the pattern. By 40 log((d + r |rho|) / (d - r |rho|)) both ways, with |rho| 0.96 and d 0.89 to 1.
  const auto scenario = overTheSea(3000, 520, {2, 2, 60}, {2, 2, 600});
  placeOver(*scenario, beamUpwards(), kShip, kShip_msl_m);
  for (const auto look : {scenario::RadarAim::scan, scenario::RadarAim::target}) {
    scenario->output.radar_look = look;
    scenario->output.quantities = {"snr_db"};
    const double expected_db = look == scenario::RadarAim::scan ? 0.361 : 0.333;
    EXPECT_NEAR(ripple_db(scenario), expected_db, 0.025) << "codes of 1/128 dB, both ways";
    scenario->output.quantities = {"power_density_dbwm2"};
    EXPECT_NEAR(ripple_db(scenario), 0.361 / 2, 0.008);
  }
  scenario->emitters[0].antenna = scenario::makeIsotropic();
  scenario->output.quantities = {"snr_db"};
  EXPECT_GT(ripple_db(scenario), 55);
  scenario->emitters[0].antenna = scenario::makeGaussian(0, 360, 180, 0);  // another kind without a direction
  EXPECT_GT(ripple_db(scenario), 55);
}

/// Power density of an emitter at a voxel in double precision, from the model's function and the antenna's
/// closed form.
struct Reference {
  double power_wm2 = 0;
  double scale_wm2 = 0;  ///< with the rays' magnitudes added
};
Reference reference(const scenario::Snapshot& snapshot, const volume::Grid& grid, int i, int j, int k) {
  const scenario::Emitter& emitter = snapshot.scenario->emitters[0];
  const scenario::EmitterState& state = snapshot.emitters[0];
  const Station station = makeStation(state.position, state.height_msl_m, 4.0 / 3);
  const GeoFrame frame(grid.frame);
  const Vec3d center = grid.center_m(i, j, k);
  const GeodeticPosition end = frame.toGeodetic(center);
  const GeodesicInverse path = geodesicInverse(state.position.latitude_deg, state.position.longitude_deg,
                                               end.latitude_deg, end.longitude_deg);
  const Vec3d line = toEcef(end) - station.ecef_m;
  Vec3d direct{dot(line, station.geodesy.east), dot(line, station.geodesy.north),
               dot(line, station.geodesy.station.up)};
  direct.z +=
      refractionLift_m(station, path.distance_m, std::hypot(direct.x, direct.y), frame.heightMsl_m(center));
  const auto amplitude = [&](const Vec3d& ray) {
    const Vec3d unit = ray / length(ray);
    return emitter.antenna->signedAmplitudeTowards(
        {dot(unit, state.beam.forward), dot(unit, state.beam.right), dot(unit, state.beam.up)},
        state.beam.steer_u, state.beam.steer_v);
  };
  double mean_loss = 0, re = 0, square = 0, weight = 0, depression = 0;
  const bool is_slanted = !propagation::isLinear(emitter.polarization);
  for (const auto polarization :
       {propagation::LinearPolarization::horizontal, propagation::LinearPolarization::vertical}) {
    if (!is_slanted && (polarization == propagation::LinearPolarization::vertical) !=
                           (emitter.polarization == propagation::Polarization::vertical))
      continue;
    propagation::TwoRayParameters parameters;
    parameters.frequency_hz = emitter.frequency_hz;
    parameters.effective_earth_radius_m = station.effective_earth_radius_m;
    parameters.ground = propagation::groundConstants(snapshot.scenario->ground, emitter.frequency_hz);
    parameters.polarization = polarization;
    parameters.sum = emitter.propagation.two_ray.sum;
    const auto two = propagation::twoRayPath(propagation::twoRayModel<double>(parameters), path.distance_m,
                                             state.height_msl_m, frame.heightMsl_m(center));
    const double part = is_slanted ? 0.5 : 1;
    mean_loss += part * dbToRatio(-two.excess_db);
    re += part * two.reflected.re;
    square += part * norm(two.reflected);
    weight = two.weight;
    depression = std::asin(two.depression_sine);
  }
  const double d = amplitude(direct);
  const double r = amplitude({std::sin(path.azimuth_rad) * std::cos(depression),
                              std::cos(path.azimuth_rad) * std::cos(depression), -std::sin(depression)});
  const bool is_envelope = emitter.propagation.two_ray.sum == propagation::TwoRaySum::envelope;
  const double product = is_envelope ? std::abs(d * r) : d * r;
  const double both = std::max(d * d + 2 * product * re + r * r * square, 1e-6 * d * d);
  const double isotropic = std::max(1 + 2 * re + square, 1e-6);
  const double boresight_wm2 =
      emitter.power_w * dbToRatio(emitter.antenna->gain_dbi) / (4 * kPi * dot(line, line)) * mean_loss;
  const double sum = std::abs(d) + std::abs(r) * std::sqrt(square);
  return {boresight_wm2 * d * d * std::pow(both / (d * d * isotropic), weight),
          boresight_wm2 * sum * sum * std::pow(isotropic, -weight)};
}

/// Asserts that each voxel of a field at time 0 has the reference's amplitude, relative to the sum of the
/// magnitudes: nulls are as deep as the phases are exact.
void expectReference(const std::shared_ptr<const scenario::Scenario>& scenario,
                     const volume::DenseVolume& volume) {
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const Dims dims = volume.grid.dims;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        const Reference expected = reference(snapshot, volume.grid, i, j, k);
        const double power_wm2 = dbToRatio(static_cast<double>(valueAt(volume, i, j, k)));
        ASSERT_NEAR(std::sqrt(power_wm2 / expected.scale_wm2),
                    std::sqrt(expected.power_wm2 / expected.scale_wm2), 4e-3)
            << i << ", " << j << ", " << k;
      }
    }
  }
}

TEST_P(TwoRays, AreWeighedByThePatternAlongEachInEveryVoxel) {
  const scenario::AntennaPtr antennas[] = {
      scenario::makeIsotropic(3),
      scenario::makeGaussian(30, 6, 8, -40),
      scenario::makeCosecant2(32, 8, 5, 40, -45),
      scenario::makeSinc(30, 15, 9, -60),
      scenario::makePhasedArray(28, 8, 12, 0.5, 1),
      scenario::readAntenna(test::shippedScenario("data/sector_450mhz.msi"))};
  using propagation::Polarization;
  const Polarization polarizations[] = {Polarization::horizontal, Polarization::vertical,
                                        Polarization::slant_45};
  int n = 0;
  for (const scenario::AntennaPtr& antenna : antennas) {
    for (const auto sum : {propagation::TwoRaySum::coherent, propagation::TwoRaySum::envelope}) {
      SCOPED_TRACE(::testing::Message() << antenna->description << ", " << toString(sum));
      auto scenario = overTheSea(0, 0, {90e3, 70e3, 3000}, {19, 16, 12});
      scenario::Emitter emitter = plainEmitter("ship", 0);
      emitter.antenna = antenna;
      emitter.frequency_hz = n % 4 < 2 ? 300e6 : 1.2e9;
      emitter.polarization = polarizations[n % 3];
      emitter.propagation.model = PropagationModel::two_ray;
      emitter.propagation.two_ray.sum = sum;
      emitter.scan.azimuth_deg = 40 + 70 * n;
      emitter.scan.elevation_deg = n % 2 == 0 ? 1.5 : -3;
      placeOver(*scenario, emitter, kShip, 25 + 10 * n);
      scenario->platforms[0].attitude = {10.0 * n, 4,
                                         -12};  // the antenna rolls: no scalar elevation would do
      scenario->output.quantities = {"power_density_dbwm2"};
      ASSERT_NO_FATAL_FAILURE(expectReference(scenario, *field(scenario)));
      ++n;
    }
  }
}

TEST_P(TwoRays, LeaningColumnUsesRangeOfEachVoxel) {
  // Columns 45 km from the origin lean by 0.4 degrees: 60 m over their 9 km.
  auto scenario = overTheSea(0, 0, {90e3, 70e3, 9000}, {19, 16, 40});
  scenario->region.origin.kind = FrameKind::enu;
  scenario::Emitter emitter = plainEmitter("ship", 0);
  emitter.antenna = scenario::makeGaussian(30, 6, 8, -40);
  emitter.frequency_hz = 3e9;
  emitter.propagation.model = PropagationModel::two_ray;
  emitter.propagation.two_ray.sum = propagation::TwoRaySum::coherent;
  placeOver(*scenario, emitter, kShip, 40);
  scenario->output.quantities = {"power_density_dbwm2"};
  expectReference(scenario, *field(scenario));
}

TEST_P(TwoRays, TurningBeamRepeatsOnlyCombination) {
  auto scenario = overTheSea(0, 0, {60e3, 50e3, 3000}, {30, 25, 20});
  scenario::Emitter radar = beamUpwards();
  radar.antenna = scenario::makePhasedArray(30, 16, 16, 0.5, 1);
  placeOver(*scenario, radar, kShip, kShip_msl_m);
  scenario->output.quantities = {"power_density_dbwm2", "snr_db"};
  FieldSolver solver(scenario, nullptr, options());
  scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  solver.update(snapshot);
  scenario->emitters[0].scan.azimuth_deg = 47;
  scenario->emitters[0].scan.elevation_deg = 1;
  snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const FieldChanged changed = solver.update(snapshot);
  EXPECT_TRUE(changed.moved.empty());
  EXPECT_EQ(changed.turned, std::vector<int>{0});
  FieldSolver fresh(scenario, nullptr, options());
  fresh.update(snapshot);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(solver.volumes()[c].host()->values, fresh.volumes()[c].host()->values);
  }
}

TEST_P(TwoRays, JammerIsWeightedAtBothEnds) {
  // One end is 20 m over the sea, the other 3 km off at 520 to 580 m. The narrow beam is at the lower end:
  // the radar's or the jammer's.
  for (const bool radar_is_low : {true, false}) {
    for (const bool is_narrow : {true, false}) {
      double lowest = HUGE_VAL, highest = -HUGE_VAL;
      for (double height_m = 520; height_m <= 580; height_m += 0.5) {
        const auto ratio_db = [&](PropagationModel model) {
          const auto scenario = overTheSea(20e3, 3400, {400, 400, 400}, {2, 2, 2});
          scenario::Emitter radar = radarOf(scenario::makeIsotropic()), jammer = jammerOf(10);
          jammer.polarization = propagation::Polarization::horizontal;
          scenario::Emitter& low = radar_is_low ? radar : jammer;
          if (is_narrow) low.antenna = beamUpwards().antenna;
          low.scan.azimuth_deg = 90;
          low.scan.elevation_deg = 10;
          jammer.propagation.model = model;
          placeOver(*scenario, radar, radar_is_low ? kShip : eastOfShip(3000),
                    radar_is_low ? kShip_msl_m : height_m);
          placeOver(*scenario, jammer, radar_is_low ? eastOfShip(3000) : kShip,
                    radar_is_low ? height_m : kShip_msl_m);
          scenario->output.quantities = {"jammer_to_signal_db"};
          return static_cast<double>(valueAt(*field(scenario), 0, 0, 0));
        };
        const double apart_db = ratio_db(PropagationModel::two_ray) - ratio_db(PropagationModel::free_space);
        lowest = std::min(lowest, apart_db);
        highest = std::max(highest, apart_db);
      }
      if (is_narrow) {
        EXPECT_NEAR(highest - lowest, 0.361 / 2, 0.01) << "radar low: " << radar_is_low;
      } else {
        EXPECT_GT(highest - lowest, 20) << "radar low: " << radar_is_low;
      }
    }
  }
}

TEST_P(TwoRays, RadarsAndJammersEqualProfile) {
  auto scenario = overTheSea(0, 0, {50e3, 40e3, 3000}, {21, 16, 13});
  scenario::Emitter radar = radarOf(scenario::makeSinc(32, 6, 4, -45)), jammer = jammerOf(50);
  radar.frequency_hz = jammer.frequency_hz = 900e6;
  radar.scan.azimuth_deg = 60;
  radar.scan.elevation_deg = 2;
  radar.propagation.model = PropagationModel::two_ray;
  jammer.antenna = scenario::makeGaussian(12, 40, 5, -20);
  jammer.scan.azimuth_deg = 280;
  jammer.propagation.model = PropagationModel::two_ray;
  placeOver(*scenario, radar, kShip, kShip_msl_m);
  scenario->platforms[0].attitude = {15, 2, -3};
  placeOver(*scenario, jammer, eastOfShip(9000), 400);
  scenario->output.quantities = {"snr_db", "jammer_to_signal_db", "detection_probability"};
  for (const auto look : {scenario::RadarAim::scan, scenario::RadarAim::target}) {
    scenario->output.radar_look = look;
    FieldSolver solver(scenario, nullptr, options());
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
    solver.update(snapshot);
    std::mt19937 random(5);
    for (int n = 0; n < 60; ++n) {
      const int i = static_cast<int>(random() % 21), j = static_cast<int>(random() % 16),
                k = static_cast<int>(random() % 13);
      const volume::Grid& grid = solver.volumes().front().host()->grid;
      const GeoFrame frame(grid.frame);
      const Vec3d center = grid.center_m(i, j, k);
      const PathBudget budget = pathBudget(snapshot, 0, {frame.toGeodetic(center), frame.heightMsl_m(center)},
                                           PropagationModel::two_ray, nullptr);
      const auto voxel = [&](int channel) {
        return static_cast<double>(valueAt(*solver.volumes()[channel].host(), i, j, k));
      };
      const double tolerance_db = budget.excess.loss_db > 20 ? 1 : 0.1;
      EXPECT_NEAR(voxel(0), budget.find("snr_db")->value, tolerance_db);
      EXPECT_NEAR(voxel(1), budget.find("jammer_to_signal_db")->value, tolerance_db);
      EXPECT_NEAR(voxel(2), budget.find("detection_probability")->value, 0.02);
    }
  }
}

EMSCAPE_ON_BACKENDS(TwoRays);

TEST(PathBudget, NamesTheGainAlongTheReflectedRay) {
  const auto scenario = overTheSea(3000, 520, {2, 2, 60}, {2, 2, 2});
  placeOver(*scenario, beamUpwards(), kShip, kShip_msl_m);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  GeodeticPosition end = eastOfShip(3000);
  end.height_ellipsoid_m = 550 + geoidUndulation_m(end.latitude_deg, end.longitude_deg);
  const auto budgetBy = [&](PropagationModel model) {
    return pathBudget(snapshot, 0, {end, 550}, model, nullptr);
  };
  const PathBudget budget = budgetBy(PropagationModel::two_ray);
  const PathPointing& pointing = budget.pointing;
  ASSERT_TRUE(pointing.reflected);
  EXPECT_NEAR(pointing.reflected->pattern_db, -40, 1e-9);
  EXPECT_NEAR(radToDeg(pointing.reflected->elevation_rad), -20.76, 0.02) << "10.76 below the horizontal";
  EXPECT_NEAR(budget.find("power_density_dbwm2")->value,
              budget.find("eirp_dbw")->value + budget.find("spreading_dbm2")->value - budget.excess.loss_db +
                  budget.find("reflected_ray_db")->value,
              1e-9);
  EXPECT_NEAR(budget.find("power_density_dbwm2")->value,
              budgetBy(PropagationModel::free_space).find("power_density_dbwm2")->value, 0.1);
  EXPECT_NE(budget.find("reflected_ray_db")->note.find("-40.00 dB along the reflected ray"),
            std::string::npos);
  EXPECT_EQ(budgetBy(PropagationModel::diffraction).find("reflected_ray_db"), nullptr);
}

}  // namespace
}  // namespace emscape::emfield
