// The model parabolic_equation between its azimuths and ranges: against single marches, and the interpolation
// itself.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/emfield/parabolic_samples.h"

namespace emscape::emfield {
namespace {

using namespace testing;

/// Largest angle (rad) at which the antenna sees ground given at regular steps, up to a range.
float horizonOf(const propagation::PeOthers& others, const std::vector<float>& ground_msl_m, double step_m,
                double range_m) {
  float horizon_rad = 0;
  for (std::size_t i = 1; i < ground_msl_m.size() && static_cast<double>(i) * step_m < range_m; ++i) {
    const auto at_m = static_cast<float>(static_cast<double>(i) * step_m);
    if (at_m < propagation::PeSight::kNearGround_m) continue;
    horizon_rad = std::max(horizon_rad, others.launchAngle(at_m, ground_msl_m[i]));
  }
  return horizon_rad;
}

// Each of 200 random points by a march along its own azimuth, averaged over the voxel as the cells are.
std::vector<double> differencesFromSingleMarches(const std::shared_ptr<scenario::Scenario>& scenario,
                                                 const scenario::TerrainPtr& terrain) {
  const auto volume = solve(scenario, terrain);
  const Dims dims = scenario->region.dims;
  const Made made(*scenario, terrain.get());
  const PePlan& plan = made.plan;
  const propagation::PeExcess excess = peField(made.inputs, made.radials).excess;
  std::mt19937 random(1);
  std::vector<double> differences;
  while (differences.size() < 200) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(dims.x)),
              j = static_cast<int>(random() % static_cast<unsigned>(dims.y)),
              k = static_cast<int>(random() % static_cast<unsigned>(dims.z));
    const auto c = static_cast<std::size_t>(j * dims.x + i);
    if (!made.columns.first_valid_k.empty() && k < made.columns.first_valid_k[c]) continue;
    const double voxel_msl_m = heightMsl_m(
        made.columns.view()[c], static_cast<double>(made.columns.t_m[static_cast<std::size_t>(k)]));
    const FastInverse foot = footInverse(made.station, made.columns.view()[c], 0);
    const auto isEquations = [&](float horizon_rad) {  // alone, without other models
      return voxel_msl_m <= plan.top_msl_m &&
             excess.others.equationPart(static_cast<float>(foot.distance_m), static_cast<float>(voxel_msl_m),
                                        terrain ? made.columns.ground_msl_m[c] : 0.0F, horizon_rad) >= 1;
    };
    if (!isEquations(0)) continue;

    propagation::RadialPath path;
    path.source.height_agl_m = made.inputs.site.height_msl_m - made.radials.site_ground_msl_m;
    path.surface = plan.surfaces[0];
    path.air = plan.air[0][0];
    const double half_m = plan.cells.meanRange_m() / 2;
    propagation::MarchGrid grid = plan.grid;  // with as many steps before the point as behind
    const bool is_even = std::lround(2 * half_m / grid.range_step_m) % 2 == 0;
    grid.range_step_m =
        foot.distance_m / (std::round(foot.distance_m / grid.range_step_m) + (is_even ? 0.5 : 0));
    const int steps = static_cast<int>((foot.distance_m + half_m) / grid.range_step_m) + 1;
    std::vector<float> ground_msl_m(static_cast<std::size_t>(steps) + 1);
    if (terrain)
      made.radials.ground(std::atan2(foot.sin_azimuth, foot.cos_azimuth), steps * grid.range_step_m,
                          grid.range_step_m, steps + 1, ground_msl_m.data());
    if (!isEquations(horizonOf(excess.others, ground_msl_m, grid.range_step_m, foot.distance_m))) continue;
    path.ground_msl_m.assign(ground_msl_m.begin(), ground_msl_m.end());
    propagation::RadialMarch<double, 1> march(grid, {path});
    double sum = 0;
    int count = 0;
    for (int step = 0; step < steps; ++step) {
      march.advance();
      if (std::abs(march.range_m() - foot.distance_m) > 0.999 * half_m) continue;
      const double z1 = std::max(0.0, voxel_msl_m - plan.cells.meanHeight_m() / 2 - march.ground_m(0));
      const double z2 = voxel_msl_m + plan.cells.meanHeight_m() / 2 - march.ground_m(0);
      if (z2 <= z1) continue;
      sum += march.meanSquaredFactor(0, z1, z2);
      ++count;
    }
    if (count == 0 || sum / count < 0.1) continue;  // nulls
    differences.push_back(std::abs(excessIn(*volume, made, i, j, k) + 10 * std::log10(sum / count)));
  }
  return differences;
}

/// 24 km wide, at 300 MHz.
std::vector<double> differencesAround(const scenario::TerrainPtr& terrain, double height_msl_m,
                                      double lowest_msl_m, double azimuths = 0,
                                      FrameKind frame = FrameKind::altitude) {
  const auto scenario = around(3e8, height_msl_m, {24e3, 24e3, 400}, {80, 80, 20}, lowest_msl_m);
  scenario->region.origin.kind = frame;
  scenario->emitters[0].propagation.parabolic_equation.azimuths = azimuths;
  return differencesFromSingleMarches(scenario, terrain);
}

TEST(ParabolicField, SLOW_EqualsSingleMarchesOverSmoothEarth) {
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    SCOPED_TRACE(toString(frame));
    const std::vector<double> differences = differencesAround(nullptr, 60, 0, 0, frame);
    recordDifferences(toString(frame), differences);
    EXPECT_LT(quantileOf(differences, 0.9), 0.1) << quantileOf(differences, 0.9);
    EXPECT_LT(quantileOf(differences, 1), 0.5) << quantileOf(differences, 1);
  }
}

// Between azimuths the terrain differs, and so do the reflections: lobes move. With azimuths one voxel apart
// at the far side, as they are in small regions by themselves, this is lost at single nulls only.
TEST(ParabolicField, SLOW_EqualsSingleMarchesOverHills) {
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    SCOPED_TRACE(toString(frame));
    const std::vector<double> differences = differencesAround(gentleHills(), 180, 80, 0, frame);
    recordDifferences(toString(frame), differences);
    EXPECT_LT(quantileOf(differences, 0.9), 0.3) << quantileOf(differences, 0.9);
    EXPECT_LT(quantileOf(differences, 1), 2) << quantileOf(differences, 1);
  }
  constexpr double kTwoVoxels = 176, kHalfVoxel = 704;  // azimuths so far apart
  const std::vector<double> finer = differencesAround(gentleHills(), 180, 80, kHalfVoxel);
  recordDifferences("half a voxel apart", finer);
  EXPECT_LT(quantileOf(finer, 1), 1.5) << quantileOf(finer, 1);
  const std::vector<double> coarser = differencesAround(gentleHills(), 180, 80, kTwoVoxels);
  recordDifferences("two voxels apart", coarser);
  EXPECT_LT(quantileOf(coarser, 0.9), 0.5) << quantileOf(coarser, 0.9);
}

/// 16 km of real ground, 60 m above it.
struct RealGround {
  std::shared_ptr<scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};

/// @param lowest_msl_m, top_m  of the field
RealGround realGround(const char* file, double latitude_deg, double longitude_deg, double frequency_hz,
                      double lowest_msl_m, double top_m, int layers) {
  RealGround made;
  made.scenario = around(frequency_hz, 0, {16e3, 16e3, top_m}, {80, 80, layers}, lowest_msl_m);
  made.terrain = standOn(file, latitude_deg, longitude_deg, 60, *made.scenario);
  return made;
}

RealGround valleyOfJacksboro() {
  return realGround("scenarios/data/jacksboro.tif", 36.25, -84.2, 4e8, 250, 600, 24);
}

RealGround whiteMountains() {
  const RealGround made = realGround("tests/data/dem/N44W072.tif", 44.26, -71.25, 3e8, 300, 1600, 40);
  made.scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 8;
  return made;
}

// Real ground changes with azimuth and with the positions of a march's steps: two marches along one azimuth,
// with shifted steps of 70 m, differ by 0.6 dB or more at one of ten points. In the valley the automatic
// angle holds slopes of 15 degrees and more, whose reflections change from one azimuth to the next.
TEST(ParabolicField, SLOW_IsNearSingleMarchesOverMountains) {
  const RealGround valley = valleyOfJacksboro(), mountains = whiteMountains();
  const std::vector<double> of_valley = differencesFromSingleMarches(valley.scenario, valley.terrain),
                            of_mountains =
                                differencesFromSingleMarches(mountains.scenario, mountains.terrain);
  recordDifferences("Jacksboro", of_valley);
  recordDifferences("White Mountains", of_mountains);
  EXPECT_LT(quantileOf(of_valley, 0.5), 0.6);
  EXPECT_LT(quantileOf(of_valley, 0.9), 3.5);
  EXPECT_LT(quantileOf(of_mountains, 0.5), 0.5);
  EXPECT_LT(quantileOf(of_mountains, 0.9), 2);
}

// With azimuths, range steps and angles fine enough the interpolation is as good as over smooth ground.
TEST(ParabolicField, SLOW_ConvergesToSingleMarchesOverMountains) {
  if (std::getenv("EMSCAPE_FINE_MARCHES") == nullptr)
    GTEST_SKIP() << "takes minutes; set EMSCAPE_FINE_MARCHES=1 to run it";
  const struct {
    const char* name;
    RealGround ground;
  } grounds[] = {{"Jacksboro", valleyOfJacksboro()}, {"White Mountains", whiteMountains()}};
  for (const auto& [name, ground] : grounds) {
    auto& settings = ground.scenario->emitters[0].propagation.parabolic_equation;
    settings.max_angle_deg = 8;
    double last_db = HUGE_VAL;
    const struct { double azimuths, range_step_m; } kMarches[] = {{0, 0}, {704, 35}, {1056, 20}, {1584, 10}};
    for (const auto& marches : kMarches) {
      settings.azimuths = marches.azimuths;
      settings.range_step_m = marches.range_step_m;
      const std::vector<double> differences = differencesFromSingleMarches(ground.scenario, ground.terrain);
      recordDifferences(
          fmt::format("{}, {:g} azimuths, steps of {:g} m", name, marches.azimuths, marches.range_step_m),
          differences);
      EXPECT_LT(quantileOf(differences, 0.9), last_db);
      last_db = quantileOf(differences, 0.9);
    }
    EXPECT_LT(last_db, 0.3) << name;
  }
}

/// Cells of 8 azimuths all around and 6 ranges, 100 m apart, with the same losses at 3 heights.
struct MadeCells {
  std::vector<float> losses_db;
  propagation::PeExcess excess;

  /// @param loss_db  of an azimuth and a range
  explicit MadeCells(const std::function<float(int, int)>& loss_db) {
    for (int a = 0; a < 8; ++a)
      for (int r = 0; r < 6; ++r) losses_db.insert(losses_db.end(), 3, loss_db(a, r));
    excess.tables = losses_db.data();
    excess.azimuths = 8;
    excess.ranges = 6;
    excess.heights = 3;
    excess.is_around = true;
    excess.azimuth_step_rad = 2 * kPi / 8;
    excess.first_range_m = 100;
    excess.range_step_m = 100;
    excess.height_step_m = 10;
    excess.top_msl_m = 30;
    excess.others.max_angle_rad = 1;
    excess.others.min_range_m = 1;
  }
  /// @param range  counted as the cells are
  float at(double azimuth, double range) const {
    propagation::ExcessColumn column;
    column.range_m = 100 + 100 * range;
    return excess
        .equationAt(column, excess.azimuthsAt(azimuth * excess.azimuth_step_rad), 15, 0,
                    [](float) { return 0.0F; })
        .equation_db;
  }
};

TEST(ParabolicField, InterpolatesBetweenAzimuthsAndRangesWithCurvature) {
  const MadeCells bowl([](int a, int r) { return 5 + 0.5F * float((a - 4) * (a - 4)) + float(r * r); });
  EXPECT_NEAR(bowl.at(3, 2), 5.5 + 4, 1e-4);
  EXPECT_NEAR(bowl.at(3.5, 2), 5.125 + 4, 1e-4);
  EXPECT_NEAR(bowl.at(4.25, 2.5), 5.03125 + 6.25, 0.02) << "outer ranges are read on lines";
  EXPECT_NEAR(bowl.at(3, 0.5), 5.5 + 0.5, 1e-4) << "the first range: a line";
  EXPECT_NEAR(bowl.at(3, 4.5), 5.5 + 20.5, 1e-4) << "the last";
  // Between the last azimuth and the first: 9.5 and 13, beside 7 and 9.5.
  EXPECT_NEAR(bowl.at(7.5, 2), 11.25 + 0.0625 * (9.5 + 13 - 7 - 9.5) + 4, 1e-4);
}

TEST(ParabolicField, InterpolatesLinearlyBesideUnknownCells) {
  const MadeCells hole(
      [](int a, int r) { return a == 2 ? NAN : 5 + 0.5F * float((a - 4) * (a - 4)) + float(r); });
  EXPECT_NEAR(hole.at(3.5, 2), 5.25 + 2, 1e-4);
  EXPECT_NEAR(hole.at(2.4, 2), 5.5 + 2, 1e-4) << "one of the two is known";
  EXPECT_NEAR(hole.at(4.5, 2), 5.125 + 2, 1e-4) << "not beside the hole";
  const MadeCells shadow([](int a, int) { return a == 2 ? 200.0F : 10.0F; });
  EXPECT_NEAR(shadow.at(3.5, 2), 8, 1e-4);
}

}  // namespace
}  // namespace emscape::emfield
