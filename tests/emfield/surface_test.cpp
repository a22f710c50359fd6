// The field over a surface equals the budgets of the paths to its positions.

#include "emscape/emfield/columns/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;

class SurfaceField : public test::OnBackends {
 protected:
  SurfaceField() {
    scenario::TerrainSpec spec;
    spec.files = {test::sourceFile("scenarios/data/jacksboro.tif")};
    spec.locations = {{spec.files[0]}};
    terrain_ = scenario::Terrain::load(spec, scenario::Terrain::describe(spec.files[0]).box);
  }

  /// A radar 20 m above a ridge, of a narrow beam.
  std::shared_ptr<scenario::Scenario> radarOnRidge(PropagationModel model) const {
    auto scenario = emptyScenario(FrameKind::altitude, 36.303, -84.246, {10e3, 10e3, 1e3}, {4, 4, 4});
    scenario->terrain = scenario::TerrainSpec{};
    scenario::Emitter emitter = plainEmitter("radar", 0);
    emitter.kind = scenario::EmitterKind::radar;
    emitter.frequency_hz = 3e9;
    emitter.power_w = 20e3;
    emitter.antenna = scenario::makeGaussian(34, 3, 8, -40);
    emitter.receiver.bandwidth_hz = 1e6;
    emitter.propagation.model = model;
    emitter.scan.kind = scenario::ScanKind::track;
    addEmitter(*scenario, {36.27, -84.24167, 0}, emitter);
    scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario->platforms[0].track[0].position.height_agl_m = 20;
    return scenario;
  }

  std::shared_ptr<Surface> positions(HeightReference reference, std::vector<double> heights_m, int width = 8,
                                     int height = 5) const {
    auto surface = std::make_shared<Surface>();
    surface->width = width;
    surface->height = height;
    surface->reference = reference;
    surface->heights_m = std::move(heights_m);
    std::mt19937 random(23);
    std::uniform_real_distribution<double> within(-0.13, 0.13);
    for (int n = 0; n < width * height; ++n)
      surface->positions.push_back({36.303 + within(random), -84.246 + within(random)});
    return surface;
  }

  /// Compares a quantity at all positions and heights above ground.
  /// @param term   of the budget
  /// @param every  compare every n-th position
  /// @param beside_borders  number of points that may differ by more
  /// @return the number of points compared
  int expectTheBudgets(const std::shared_ptr<scenario::Scenario>& scenario,
                       const std::shared_ptr<Surface>& surface, const char* term, double tolerance,
                       std::size_t every = 1, int beside_borders = 0) const {
    FieldOptions options;
    options.backend = GetParam();
    options.surface = surface;
    const auto volume = solve(scenario, terrain_, options);
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain_.get(), 0);
    int compared = 0;
    for (std::size_t p = 0; p < surface->positions.size(); p += every) {
      const auto [latitude_deg, longitude_deg] = surface->positions[p];
      const double ground_msl_m = terrain_->heightMsl_m(latitude_deg, longitude_deg);
      for (std::size_t k = 0; k < surface->heights_m.size(); ++k) {
        const double offset_m = surface->offsets_m.empty() ? 0 : static_cast<double>(surface->offsets_m[p]);
        const bool above_ground = surface->reference == HeightReference::ground;
        const double height_msl_m = surface->heights_m[k] + offset_m + (above_ground ? ground_msl_m : 0);
        const float found = volume->values[k * surface->positions.size() + p];
        EXPECT_EQ(volume->first_valid_k[p] > k, height_msl_m < ground_msl_m);
        if (height_msl_m < ground_msl_m) continue;
        const PathEnd end{
            {latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)},
            height_msl_m};
        const PathBudget budget =
            pathBudget(snapshot, 0, end, scenario->emitters[0].propagation.model, terrain_.get());
        const double expected = budget.find(term)->value;
        ++compared;
        if (std::isinf(expected)) {
          EXPECT_EQ(found, volume->info.floor);
        } else if (std::abs(static_cast<double>(found) - expected) <= tolerance || beside_borders-- <= 0) {
          EXPECT_NEAR(static_cast<double>(found), expected, tolerance)
              << term << " at " << latitude_deg << ", " << longitude_deg << ", " << height_msl_m << " m";
        }
      }
    }
    return compared;
  }

  scenario::TerrainPtr terrain_;
};

TEST_P(SurfaceField, SLOW_EqualsPathsAboveGroundWithEveryModel) {
  for (const auto model : {PropagationModel::free_space, PropagationModel::horizon,
                           PropagationModel::diffraction, PropagationModel::itm, PropagationModel::two_ray,
                           PropagationModel::p528, PropagationModel::p1812, PropagationModel::p452}) {
    SCOPED_TRACE(propagation::toString(model));
    const auto scenario = radarOnRidge(model);
    const auto surface = positions(HeightReference::ground, {2, 30, 75, 150, 300, 800, 2000});
    EXPECT_EQ(expectTheBudgets(scenario, surface, "power_density_dbwm2", 0.01), 280);
    scenario->output.quantities = {"detection_probability"};
    scenario->output.radar_look = scenario::RadarAim::target;
    // two_ray keeps the reflected ray's amplitude in 16 bits.
    expectTheBudgets(scenario, surface, "detection_probability",
                     model == PropagationModel::two_ray ? 2e-4 : 1e-4);
  }
}

// With this many positions the searches for obstacles use bounds of the terrain and, on the CPU, of rays.
TEST_P(SurfaceField, SLOW_EqualsPathsAtManyPositions) {
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const auto surface = positions(HeightReference::ground, {5, 40, 150, 600}, 300, 200);
  EXPECT_EQ(expectTheBudgets(scenario, surface, "power_density_dbwm2", 0.01, 60), 4000);
  scenario->output.quantities = {"detection_probability"};
  scenario->output.radar_look = scenario::RadarAim::target;
  expectTheBudgets(scenario, surface, "detection_probability", 2e-4, 60);  // 0.001 dB where it is steep
  // An emitter in a valley, whose near slopes hide most positions, and rays bent by an exponential
  // atmosphere.
  scenario->platforms[0].track[0].position.latitude_deg = 36.33;
  scenario->platforms[0].track[0].position.height_agl_m = 3;
  scenario->atmosphere.refraction = propagation::RefractionProfile::exponential;
  scenario->output.quantities = {"power_density_dbwm2"};
  EXPECT_EQ(expectTheBudgets(scenario, surface, "power_density_dbwm2", 0.01, 60), 4000);
}

/// Hills with patches of woods, houses, water and unknown cells of some 10 m, or with a surface model of the
/// same posts that has a void.
class CoveredHills : public MadeTerrain {
 public:
  explicit CoveredHills(bool has_surface)
      : MadeTerrain(36.303, -84.246, 0.3),
        surface_(36.303, -84.246, 0.3,
                 [&, patches = std::mt19937(5)](double east_deg, double north_deg) mutable {
                   const double above_m = 30 * within(patches) - 10;
                   return std::hypot(east_deg - 0.05, north_deg - 0.05) < 0.01
                              ? std::numeric_limits<double>::quiet_NaN()
                              : double(MadeTerrain::view().heightAt(degToRad(36.153 + north_deg),
                                                                    degToRad(-84.396 + east_deg))) +
                                    above_m;
                 }) {
    using scenario::CoverZone;
    constexpr int kCells = 3200, kPatch = 3;
    std::mt19937 patches(3);
    cells_.resize(kCells * kCells);
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const bool is_new = j % kPatch == 0 && i % kPatch == 0;
        const int of_patch = (j - j % kPatch) * kCells + i - i % kPatch;
        cells_[j * kCells + i] = is_new ? std::uint8_t(6 * within(patches)) : cells_[of_patch];
      }
    }
    view_ = MadeTerrain::view();
    view_.cover = {cells_.data(),           kCells,          kCells,
                   degToRad(36.15),         degToRad(-84.4), kCells / degToRad(0.31),
                   kCells / degToRad(0.31), kClasses,        5};
    if (has_surface) {
      surface_view_ = surface_.view();
      view_.surfaces = surface_view_.rasters;
      view_.surface_count = 1;
    }
  }
  scenario::TerrainView view() const override { return view_; }

 private:
  static double within(std::mt19937& random) { return std::uniform_real_distribution<double>()(random); }

  static constexpr scenario::CoverValues kClasses[5] = {{true, 15, scenario::CoverZone::land},
                                                        {true, 8, scenario::CoverZone::land},
                                                        {true, 0, scenario::CoverZone::land},
                                                        {true, 0, scenario::CoverZone::water},
                                                        {true, 20, scenario::CoverZone::land}};
  MadeTerrain surface_;
  std::vector<std::uint8_t> cells_;
  scenario::TerrainView view_, surface_view_;
};

// Budgets read the clutter of every post. On a GPU posts are placed within millimetres, so that a few are on
// the other side of the border between two kinds of cover.
TEST_P(SurfaceField, SLOW_WithClutterEqualsPathsAtManyPositions) {
  for (const bool has_surface : {false, true}) {
    SCOPED_TRACE(has_surface);
    terrain_ = std::make_shared<CoveredHills>(has_surface);
    const auto scenario = radarOnRidge(PropagationModel::diffraction);
    const auto surface = positions(HeightReference::ground, {5, 40, 150, 600}, 300, 200);
    const int beside_borders = GetParam() == Backend::cuda ? 20 : 0;
    const char* const term = "power_density_dbwm2";
    EXPECT_EQ(expectTheBudgets(scenario, surface, term, 0.01, 60, beside_borders), 4000);
    scenario->platforms[0].track[0].position.height_agl_m = 3;
    EXPECT_EQ(expectTheBudgets(scenario, surface, term, 0.01, 60, beside_borders), 4000);
  }
}

// The same of shadows, which are equal.
TEST_P(SurfaceField, ShadowsOfManyPositionsEqualThoseOfFew) {
  for (const bool has_void : {false, true}) {
    if (has_void) terrain_ = std::make_shared<MadeTerrain>(36.303, -84.246, 0.3, 0.04);
    for (const auto refraction :
         {propagation::RefractionProfile::linear, propagation::RefractionProfile::exponential}) {
      const auto scenario = radarOnRidge(PropagationModel::horizon);
      scenario->platforms[0].track[0].position.height_agl_m = 3;
      scenario->atmosphere.refraction = refraction;
      const auto many = positions(HeightReference::ground, {2, 20, 150}, 300, 200);
      FieldOptions options;
      options.backend = GetParam();
      options.allow_missing_terrain = true;
      options.surface = many;
      const auto of_many = solve(scenario, terrain_, options);
      int lit = 0, dark = 0;
      constexpr std::size_t kPart = 6000;
      for (std::size_t first = 0; first < many->positions.size(); first += kPart) {
        auto few = std::make_shared<Surface>(*many);
        few->width = 100;
        few->height = static_cast<int>(kPart / 100);
        few->positions.assign(many->positions.begin() + static_cast<std::ptrdiff_t>(first),
                              many->positions.begin() + static_cast<std::ptrdiff_t>(first + kPart));
        options.surface = few;
        const auto of_few = solve(scenario, terrain_, options);
        for (std::size_t p = 0; p < kPart; ++p) {
          ASSERT_EQ(of_many->first_valid_k[first + p], of_few->first_valid_k[p]);
          for (std::size_t k = of_few->first_valid_k[p]; k < 3; ++k) {
            const float value = of_few->values[k * kPart + p], floor = of_few->info.floor;
            const float found = of_many->values[k * many->positions.size() + first + p];
            ASSERT_EQ(found > floor, value > floor) << first + p;
            ASSERT_NEAR(found, value, 1e-4);
            ++(value > floor ? lit : dark);
          }
        }
      }
      EXPECT_GT(lit, 1000);
      EXPECT_GT(dark, 10000);
    }
  }
}

// Few positions are computed from their whole profiles, many by a search that reads parts of them. At low
// frequencies the smooth earth below most of them has a loss, or has none because obstacles lower it.
TEST_P(SurfaceField, ManyPositionsAroundAVoidEqualFew) {
  terrain_ = std::make_shared<MadeTerrain>(36.303, -84.246, 0.3, 0.04);
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const auto many = positions(HeightReference::ground, {5, 150}, 300, 200);
  auto few = std::make_shared<Surface>(*many);
  few->width = 10;
  few->height = 100;
  few->positions.clear();
  for (std::size_t p = 0; p < many->positions.size(); p += 60) few->positions.push_back(many->positions[p]);
  for (const double frequency_hz : {3e9, 300e6, 50e6}) {
    SCOPED_TRACE(frequency_hz);
    scenario->emitters[0].frequency_hz = frequency_hz;
    FieldOptions options;
    options.backend = GetParam();
    options.allow_missing_terrain = true;
    options.surface = many;
    const auto of_many = solve(scenario, terrain_, options);
    options.surface = few;
    const auto of_few = solve(scenario, terrain_, options);
    int behind = 0;
    for (std::size_t p = 0; p < few->positions.size(); ++p) {
      ASSERT_EQ(of_many->first_valid_k[60 * p], of_few->first_valid_k[p]);
      const auto [latitude_deg, longitude_deg] = few->positions[p];
      if (of_few->first_valid_k[p] > 0) {
        behind += std::isnan(terrain_->heightMsl_m(latitude_deg, longitude_deg)) ? 0 : 1;
        continue;
      }
      for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_NEAR(of_many->values[k * many->positions.size() + 60 * p],
                    of_few->values[k * few->positions.size() + p], 0.01);
      }
    }
    EXPECT_GT(behind, 5);
    EXPECT_LT(behind, 200);
  }
}

TEST_P(SurfaceField, AboveSeaLevelIsMaskedBelowGround) {
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const int compared = expectTheBudgets(
      scenario, positions(HeightReference::mean_sea_level, {350, 600, 2000}), "power_density_dbwm2", 0.01);
  EXPECT_GT(compared, 40);
  EXPECT_LT(compared, 120);
}

TEST_P(SurfaceField, WithoutTerrainIsMaskedBelowMeanSeaLevel) {
  const auto scenario = emptyScenario(FrameKind::altitude, 36.3, -84.25, {4000, 4000, 400}, {4, 4, 4});
  scenario->region.origin.height_msl_m = -200;
  addEmitter(*scenario, {36.3, -84.25, 100}, plainEmitter("mast", 0));
  FieldOptions options;
  options.backend = GetParam();
  EXPECT_EQ(solve(scenario, nullptr, options)->first_valid_k, std::vector<std::uint16_t>(16, 2));
  options.surface = positions(HeightReference::mean_sea_level, {-100, -0.5, 0, 50});
  EXPECT_EQ(solve(scenario, nullptr, options)->first_valid_k, std::vector<std::uint16_t>(40, 2));
}

TEST_P(SurfaceField, OffsetsMayDifferPerPosition) {
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const auto surface = positions(HeightReference::ground, {0, 10});
  for (std::size_t p = 0; p < surface->positions.size(); ++p) {
    surface->offsets_m.push_back(5 + 30 * static_cast<float>(p));
  }
  EXPECT_EQ(expectTheBudgets(scenario, surface, "power_density_dbwm2", 0.01), 80);
}

TEST_P(SurfaceField, OmitsPositionsWithoutALatitude) {
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const auto surface = positions(HeightReference::ground, {100});
  FieldOptions options;
  options.backend = GetParam();
  options.surface = surface;
  const auto all = solve(scenario, terrain_, options);
  auto fewer = std::make_shared<Surface>(*surface);
  for (std::size_t p = 0; p < fewer->positions.size(); p += 3) fewer->positions[p].latitude_deg = NAN;
  options.surface = fewer;
  const auto some = solve(scenario, terrain_, options);
  for (std::size_t p = 0; p < fewer->positions.size(); ++p) {
    EXPECT_EQ(some->first_valid_k[p], p % 3 == 0 ? 1 : 0);
    EXPECT_EQ(some->values[p], p % 3 == 0 ? some->info.floor : all->values[p]);
  }
  for (Surface::Position& place : fewer->positions) place.latitude_deg = NAN;
  EXPECT_THROW(solve(scenario, terrain_, options), Error);
}

TEST_P(SurfaceField, HasGroundBelowItsPositions) {
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  const auto surface = positions(HeightReference::ground, {100}, 100, 50);
  surface->positions[7].latitude_deg = NAN;
  FieldOptions options;
  options.backend = GetParam();
  options.surface = surface;
  const FieldSolver solver(scenario, terrain_, options);
  const std::vector<float>& ground_msl_m = solver.groundHeights_m();
  ASSERT_EQ(ground_msl_m.size(), surface->positions.size());
  for (std::size_t p = 0; p < surface->positions.size(); ++p) {
    if (p == 7) continue;
    const auto [latitude_deg, longitude_deg] = surface->positions[p];
    EXPECT_NEAR(static_cast<double>(ground_msl_m[p]), terrain_->heightMsl_m(latitude_deg, longitude_deg),
                1e-3);
  }
}

/// A GPU keeps the columns to itself until a model needs them on the host.
TEST_P(SurfaceField, SLOW_AfterEditToRadialModelEqualsNewSolver) {
  const auto surface = positions(HeightReference::ground, {100}, 12, 10);
  FieldOptions options;
  options.backend = GetParam();
  options.surface = surface;
  const auto scenario = radarOnRidge(PropagationModel::diffraction);
  SolvedField solver(scenario, terrain_, options);
  const auto edited = radarOnRidge(PropagationModel::parabolic_equation);
  solver.update(scenario::snapshotAt(edited, terrain_.get(), 0), terrain_);
  EXPECT_EQ(solver.volumes().front().host()->values, solve(edited, terrain_, options)->values);
}

EMSCAPE_ON_BACKENDS(SurfaceField);

}  // namespace
}  // namespace emscape::emfield
