// The model parabolic_equation in the field: cells between azimuths against marches of their own, other
// models around it, seams, edits, limits.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "emfield/columns/foot_inverse.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/radials.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/parabolic_equation/model.h"
#include "propagation/parabolic_equation/path_air.h"
#include "propagation/parabolic_equation/plan.h"
#include "propagation/parabolic_equation/refractivity_field.h"
#include "scenario/antenna/shapes.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "volume/labels.h"

namespace emscape::emfield {
namespace {

using propagation::PePlan;
using propagation::Polarization;
using propagation::PropagationModel;
using propagation::RadialInputs;
using testing::MadeTerrain;
using testing::solve;

constexpr double kLatitude_deg = 51, kLongitude_deg = 5;

/// One emitter in the middle of a region, antenna at a height above mean sea level.
std::shared_ptr<scenario::Scenario> around(double frequency_hz, double height_msl_m, Vec3d size_m, Dims dims,
                                           double lowest_msl_m = 0) {
  auto scenario = testing::emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, size_m, dims);
  scenario->region.origin.height_msl_m = lowest_msl_m;
  scenario->atmosphere.gases = propagation::GasLosses::never;
  scenario::Emitter emitter = testing::plainEmitter("tower", 0);
  emitter.frequency_hz = frequency_hz;
  emitter.polarization = Polarization::horizontal;
  emitter.propagation.model = PropagationModel::parabolic_equation;
  testing::addEmitter(*scenario, {kLatitude_deg, kLongitude_deg, 0}, emitter);
  scenario::SitePosition& site = scenario->platforms[0].track[0].position;
  site.height_ellipsoid_m.reset();
  site.height_msl_m = height_msl_m;
  return scenario;
}

/// Gentle hills, 60 m high and some 5 km apart.
scenario::TerrainPtr gentleHills() {
  return std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 1.0, [](double east, double north) {
        return 100 + 30 * std::sin(80 * east + 1) * std::cos(50 * north) +
               15 * std::sin(190 * north + 40 * east);
      });
}

/// Moves region and emitter to a position on the terrain of a file.
/// @param antenna_agl_m  above the ground
scenario::TerrainPtr standOn(const char* file, double latitude_deg, double longitude_deg,
                             double antenna_agl_m, scenario::Scenario& scenario) {
  scenario::SitePosition& site = scenario.platforms[0].track[0].position;
  scenario.region.origin.latitude_deg = site.latitude_deg = latitude_deg;
  scenario.region.origin.longitude_deg = site.longitude_deg = longitude_deg;
  scenario::TerrainSpec spec;
  spec.files = {test::sourceFile(file)};
  spec.locations = {{spec.files[0]}};
  const auto terrain = scenario::Terrain::load(spec, scenario::terrainBox(scenario));
  site.height_msl_m = terrain->heightMsl_m(latitude_deg, longitude_deg) + antenna_agl_m;
  return terrain;
}

/// What the excess of the first emitter is made from.
struct Made {
  Station station;
  GridColumns columns;
  RadialInputs radials;
  propagation::PathInputs inputs;
  PePlan plan;

  Made(const scenario::Scenario& scenario, const scenario::Terrain* terrain)
      : station(makeStation(stateOf(scenario, terrain).position, stateOf(scenario, terrain).height_msl_m,
                            scenario.atmosphere)),
        columns(makeGridColumns(gridOf(scenario.region), terrain)),
        radials(radialInputs(station, columns, terrain, pathExtent(station, columns))),
        inputs(pathInputs(scenario, scenario.emitters[0], stateOf(scenario, terrain).beam, station, terrain,
                          pathExtent(station, columns))),
        plan(planMarch(inputs, radials)) {}

  static scenario::EmitterState stateOf(const scenario::Scenario& scenario,
                                        const scenario::Terrain* terrain) {
    return scenario::snapshotAt(std::make_shared<scenario::Scenario>(scenario), terrain, 0).emitters[0];
  }
};

/// The excess, its march done.
struct Marched {
  std::vector<float> tables;
  propagation::PeExcess excess;

  explicit Marched(const Made& made) {
    propagation::PeField field = peField(made.inputs, made.radials);
    tables.resize(field.march.cellCount());
    excess = field.excess;
    excess.warnings |= marchField(field.march, tables.data());
    excess.tables = tables.data();
  }
};

/// Excess (dB) of the emitter's voxels: with an isotropic antenna the rest is free space.
double excessIn(const volume::DenseVolume& volume, const Made& made, int i, int j, int k) {
  const GridColumn column = made.columns.view()[static_cast<std::size_t>(j * volume.grid.dims.x + i)];
  const Vec3d position =
      column.base_ecef_m + column.axis * static_cast<double>(made.columns.t_m[static_cast<std::size_t>(k)]);
  const double distance_m = length(position - made.station.ecef_m);
  return 10 * std::log10(1000 / (4 * kPi * distance_m * distance_m)) -
         static_cast<double>(testing::valueAt(volume, i, j, k));
}

std::shared_ptr<propagation::Refractivity> duct(std::vector<double> heights_m) {
  auto refractivity = std::make_shared<propagation::Refractivity>();
  const auto airOf = [](double height_m) {
    propagation::RefractivityField field;
    field.profiles = {propagation::evaporationDuct(height_m)};
    return field;
  };
  refractivity->air = airOf(heights_m.front());
  if (heights_m.size() > 1)
    for (const double height_m : heights_m) refractivity->members.push_back(airOf(height_m));
  return refractivity;
}

/// A radar 10 m above the sea at 10 GHz.
std::shared_ptr<scenario::Scenario> overTheSea(double highest_m, int layers) {
  const auto scenario = around(10e9, 10, {160e3, 300, highest_m}, {160, 3, layers});
  scenario->ground.kind = propagation::GroundKind::sea;
  return scenario;
}

double quantileOf(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

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
      return voxel_msl_m <= plan.top_m &&
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

void recordDifferences(const std::string& what, const std::vector<double>& differences_db) {
  for (const double part : {0.5, 0.9, 0.98, 1.0})
    ::testing::Test::RecordProperty(what + " " + std::to_string(part),
                                    std::to_string(quantileOf(differences_db, part)));
}

TEST(ParabolicField, EqualsSingleMarchesOverSmoothEarth) {
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
TEST(ParabolicField, EqualsSingleMarchesOverHills) {
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    SCOPED_TRACE(toString(frame));
    const std::vector<double> differences = differencesAround(gentleHills(), 180, 80, 0, frame);
    recordDifferences(toString(frame), differences);
    EXPECT_LT(quantileOf(differences, 0.9), 0.3) << quantileOf(differences, 0.9);
    EXPECT_LT(quantileOf(differences, 1), 1.5) << quantileOf(differences, 1);
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
// with shifted steps of 70 m, differ by 0.6 dB or more at one of ten points.
TEST(ParabolicField, IsNearSingleMarchesOverMountains) {
  const RealGround valley = valleyOfJacksboro(), mountains = whiteMountains();
  const std::vector<double> of_valley = differencesFromSingleMarches(valley.scenario, valley.terrain),
                            of_mountains =
                                differencesFromSingleMarches(mountains.scenario, mountains.terrain);
  recordDifferences("Jacksboro", of_valley);
  recordDifferences("White Mountains", of_mountains);
  EXPECT_LT(quantileOf(of_valley, 0.5), 0.4);
  EXPECT_LT(quantileOf(of_valley, 0.9), 1.5);
  EXPECT_LT(quantileOf(of_mountains, 0.5), 0.5);
  EXPECT_LT(quantileOf(of_mountains, 0.9), 2);
}

// With azimuths, range steps and angles fine enough the interpolation is as good as over smooth ground.
TEST(ParabolicField, ConvergesToSingleMarchesOverMountains) {
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
    excess.top_m = 30;
    excess.others.max_angle_rad = 1;
    excess.others.min_range_m = 1;
  }
  /// @param range  counted as the cells are
  float at(double azimuth, double range) const {
    propagation::ExcessColumn column;
    column.range_m = 100 + 100 * range;
    return excess.equationAt(column, excess.azimuthsAt(azimuth * excess.azimuth_step_rad), 15, 0).equation_db;
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

// Lobes that the voxels resolve.
TEST(ParabolicField, IsTwoRayInsideTheHorizonOverTheSea) {
  const auto scenario = around(1e9, 30, {20e3, 300, 200}, {400, 3, 80});
  scenario->ground.kind = propagation::GroundKind::sea;
  const auto volume = solve(scenario);
  scenario->emitters[0].propagation.model = PropagationModel::two_ray;
  const auto expected = solve(scenario);
  std::vector<double> differences;
  for (int i = 0; i < 400; ++i) {
    if (std::abs(i - 199.5) * 50 < 4000) continue;
    for (int k = 0; k < 80; ++k) {
      const double expected_db = static_cast<double>(testing::valueAt(*expected, i, 1, k));
      differences.push_back(std::abs(static_cast<double>(testing::valueAt(*volume, i, 1, k)) - expected_db));
    }
  }
  EXPECT_LT(quantileOf(differences, 0.5), 0.2);
  EXPECT_LT(quantileOf(differences, 0.8), 1.0);  // the rest are nulls, which the cells fill
}

/// Differences (dB) from two rays weighed by the antenna, where those are not in a null.
std::vector<double> differencesFromWeighedRays(const std::shared_ptr<scenario::Scenario>& scenario) {
  scenario->emitters[0].propagation.model = PropagationModel::two_ray;
  const auto expected = solve(scenario);
  scenario->emitters[0].propagation.model = PropagationModel::parabolic_equation;
  const auto volume = solve(scenario);
  std::vector<double> differences;
  for (int i = 140; i < 200; ++i) {  // 4 km and more to the east
    for (int k = 0; k < 80; ++k) {
      differences.push_back(std::abs(
          static_cast<double>(testing::valueAt(*volume, i, 1, k) - testing::valueAt(*expected, i, 1, k))));
    }
  }
  return differences;
}

TEST(ParabolicField, PatternWeightsBothRaysByTheirAngles) {
  const auto scenario = around(1e9, 30, {20e3, 300, 200}, {200, 3, 80});
  scenario->ground.kind = propagation::GroundKind::sea;
  scenario::Emitter& emitter = scenario->emitters[0];
  const auto aim = [&](double width_deg, double tilt_deg, propagation::PeRadiator source) {
    emitter.antenna = scenario::makeGaussian(20, 30, width_deg, -40);
    emitter.scan.azimuth_deg = 90;
    emitter.scan.elevation_deg = tilt_deg;
    emitter.propagation.parabolic_equation.source = source;
  };
  using propagation::PeRadiator;
  for (const double tilt_deg : {1.0, -0.5}) {
    SCOPED_TRACE(tilt_deg);
    aim(2, tilt_deg, PeRadiator::pattern);
    const std::vector<double> differences = differencesFromWeighedRays(scenario);
    EXPECT_LT(quantileOf(differences, 0.5), 0.2);
    EXPECT_LT(quantileOf(differences, 0.8), 1.0);
  }
  aim(2, 1, PeRadiator::isotropic);
  EXPECT_GT(quantileOf(differencesFromWeighedRays(scenario), 0.5), 2.0) << "lobes and nulls";

  // A pattern that is wide for the equation's angles changes nothing.
  aim(60, 0, PeRadiator::pattern);
  const auto weighed = solve(scenario);
  aim(60, 0, PeRadiator::isotropic);
  const auto isotropic = solve(scenario);
  std::vector<double> differences;
  for (std::size_t v = 0; v < weighed->values.size(); ++v)
    differences.push_back(std::abs(static_cast<double>(weighed->values[v] - isotropic->values[v])));
  EXPECT_LT(quantileOf(differences, 0.99), 0.1);
}

/// Differences (dB) between the equation and two rays where they are blended, by the angle and by the range,
/// over a smooth earth.
struct Seam {
  std::vector<double> all, outside_nulls;
  double largest_step_db = 0;  ///< by the blend alone, from a voxel to the one above or below
};

Seam seamOf(double frequency_hz, double height_m) {
  const auto scenario = around(frequency_hz, height_m, {12e3, 300, 800}, {240, 3, 160});
  const Made made(*scenario, nullptr);
  const Marched marched(made);
  const propagation::PeExcess& excess = marched.excess;
  Seam seam;
  for (double range_m = 1.5 * made.plan.min_range_m; range_m < 6e3; range_m += 13) {
    propagation::ExcessColumn column;
    column.range_m = range_m;
    for (float at_m = 22.5F; at_m < 700; at_m += 5) {
      const propagation::PeLoss loss =
          excess.equationAt(column, excess.azimuthsAt(column.azimuth_rad), at_m, 0);
      if (loss.equation_part <= 0 || loss.equation_part >= 1) continue;
      column.height_msl_m = &at_m;
      column.count = 1;
      float other_db = 0;
      excess.others.fill(column, {}, &other_db);
      seam.all.push_back(static_cast<double>(std::abs(loss.equation_db - other_db)));
      for (const float beside_m : {at_m - 5, at_m + 5}) {
        const float beside = excess.others.equationPart(static_cast<float>(range_m), beside_m, 0, 0);
        seam.largest_step_db =
            std::max(seam.largest_step_db, std::abs(double(beside - loss.equation_part)) * seam.all.back());
      }
      if (other_db < 3) seam.outside_nulls.push_back(seam.all.back());
    }
  }
  return seam;
}

TEST(ParabolicField, HasNoSeamOverASmoothEarth) {
  const struct {
    double frequency_hz, height_m;
  } kAntennas[] = {{3e8, 30}, {1e9, 30}, {1e9, 100}, {3e9, 15}, {3e9, 60}, {1e10, 10}};
  for (const auto& antenna : kAntennas) {
    const std::string what = fmt::format("{:g} MHz, {:g} m", antenna.frequency_hz / 1e6, antenna.height_m);
    SCOPED_TRACE(what);
    const Seam seam = seamOf(antenna.frequency_hz, antenna.height_m);
    ASSERT_GT(seam.outside_nulls.size(), 1900u);
    recordDifferences(what, seam.all);
    recordDifferences(what + ", outside nulls", seam.outside_nulls);
    EXPECT_LT(quantileOf(seam.all, 0.5), 0.2);
    EXPECT_LT(quantileOf(seam.all, 0.95), 0.5) << quantileOf(seam.all, 0.95);
    EXPECT_LT(quantileOf(seam.all, 1), 1.2) << quantileOf(seam.all, 1);
    recordDifferences(what + ", step", {seam.largest_step_db});
    EXPECT_LT(seam.largest_step_db, 0.5);
  }
}

// The places' exact paths, which are not averaged, against voxels that are smaller than lobes.
TEST(ParabolicField, EqualsExplainedPathOverSmoothEarth) {
  const auto scenario = around(1e9, 50, {120e3, 300, 300}, {400, 3, 60});
  const auto volume = solve(scenario);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const GeoFrame frame(volume->grid.frame);
  for (int i : {10, 60, 110, 160}) {
    for (int k : {4, 30, 55}) {
      const GeodeticPosition position = frame.toGeodetic(volume->grid.center_m(i, 1, k));
      const PathEnd end{position, volume->grid.center_m(i, 1, k).z};
      const PathBudget budget = pathBudget(snapshot, 0, end, PropagationModel::parabolic_equation, nullptr);
      if (budget.excess.loss_db > 10) continue;  // nulls
      EXPECT_NEAR(budget.find("power_density_dbwm2")->value,
                  static_cast<double>(testing::valueAt(*volume, i, 1, k)), 0.7)
          << i << ", " << k << ": " << budget.excess.why;
    }
  }
}

// The loss is the same from a low antenna to a high place and back.
TEST(ParabolicField, IsReciprocalOverASmoothEarth) {
  const auto low = around(3e8, 12.5, {80e3, 300, 300}, {160, 3, 60});
  const auto high = around(3e8, 202.5, {80e3, 300, 300}, {160, 3, 60});
  const auto upwards = solve(low), downwards = solve(high);
  for (int i : {4, 20, 50}) {
    const double up = static_cast<double>(testing::valueAt(*upwards, i, 1, 40));
    EXPECT_NEAR(up, static_cast<double>(testing::valueAt(*downwards, i, 1, 2)), 0.3) << i;
  }
}

/// Differences (dB) from diffraction where the equation speaks.
struct OverDiffraction {
  std::vector<double> in_sight_db, in_shadow_db;  ///< in shadow: 10 dB and more below free space
};

OverDiffraction overDiffraction(const std::shared_ptr<scenario::Scenario>& scenario,
                                const scenario::TerrainPtr& terrain) {
  const auto power = solve(scenario, terrain);
  scenario->output.quantities = {"dominant_model"};
  const auto model = solve(scenario, terrain);
  const Made made(*scenario, terrain.get());
  scenario->output.quantities = {"power_density_dbwm2"};
  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  const auto other = solve(scenario, terrain);
  OverDiffraction differences;
  const Dims dims = power->grid.dims;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        const auto column = static_cast<std::size_t>(j * dims.x + i);
        if (k < made.columns.first_valid_k[column] ||
            testing::valueAt(*model, i, j, k) !=
                static_cast<float>(propagation::Mechanism::parabolic_equation))
          continue;
        const bool is_shadow = excessIn(*other, made, i, j, k) >= 10;
        (is_shadow ? differences.in_shadow_db : differences.in_sight_db)
            .push_back(
                static_cast<double>(testing::valueAt(*power, i, j, k) - testing::valueAt(*other, i, j, k)));
      }
    }
  }
  return differences;
}

TEST(ParabolicField, IsNearDiffractionOverHills) {
  const auto scenario = around(3e8, 180, {24e3, 24e3, 400}, {40, 40, 20}, 80);
  const OverDiffraction differences = overDiffraction(scenario, gentleHills());
  for (const double part : {0.1, 0.5, 0.9})
    RecordProperty("in_sight_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_sight_db, part)));
  ASSERT_GT(differences.in_sight_db.size(), 5000u);
  EXPECT_LT(std::abs(quantileOf(differences.in_sight_db, 0.5)), 6);
}

// Steep mountains of the SRTM: behind ridges the two models agree within some dB, and a march that does not
// see them is 20 dB and more above.
TEST(ParabolicField, IsNearDiffractionOverMountains) {
  const auto scenario = around(3e8, 0, {16e3, 16e3, 1600}, {24, 24, 16}, 500);
  const auto terrain = standOn("tests/data/dem/N44W072.tif", 44.26, -71.25, 30, *scenario);
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 10;
  const OverDiffraction differences = overDiffraction(scenario, terrain);
  for (const double part : {0.1, 0.5, 0.9}) {
    RecordProperty("in_sight_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_sight_db, part)));
    RecordProperty("in_shadow_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_shadow_db, part)));
  }
  ASSERT_GT(differences.in_shadow_db.size(), 500u);
  ASSERT_GT(differences.in_sight_db.size(), 500u);
  EXPECT_LT(std::abs(quantileOf(differences.in_sight_db, 0.5)), 3);
  EXPECT_LT(std::abs(quantileOf(differences.in_shadow_db, 0.5)), 6);
}

// A ridge at 4 degrees of elevation: a band of 3 degrees does not hold the rays over it.
TEST(ParabolicField, DiffractionUsedBehindSteepRidge) {
  constexpr double kMetresPerDegree = 70e3;  // eastwards; degrees count from the western side
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return std::max(0.0, 450 - std::abs((east - 0.5) * kMetresPerDegree - 6000) * 0.18);
      });
  const auto scenario = around(3e8, 30, {24e3, 4e3, 500}, {80, 8, 10});
  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  const auto diffraction = solve(scenario, terrain);
  scenario->emitters[0].propagation.model = PropagationModel::parabolic_equation;
  const auto volume = solve(scenario, terrain);
  for (int i = 66; i < 80; ++i) {  // from 8 km to 12 km, in the shadow
    for (int j = 0; j < 8; ++j)
      EXPECT_NEAR(testing::valueAt(*volume, i, j, 1), testing::valueAt(*diffraction, i, j, 1), 0.02);
  }
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 10;
  EXPECT_GT(std::abs(testing::valueAt(*solve(scenario, terrain), 70, 4, 1) -
                     testing::valueAt(*diffraction, 70, 4, 1)),
            1);  // the equation
}

// Marches toward that ridge end behind it, others at the region's border.
TEST(ParabolicField, MarchEndsAtSteepRidge) {
  constexpr double kMetresPerDegree = 70e3;
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return std::max(0.0, 450 - std::abs((east - 0.5) * kMetresPerDegree - 6000) * 0.18);
      });
  const auto scenario = around(3e8, 30, {24e3, 4e3, 500}, {80, 8, 10});
  const Made made(*scenario, terrain.get());
  const propagation::PeField field = peField(made.inputs, made.radials);
  const propagation::AzimuthMarch& march = field.march.march;
  const auto reached_m = [&](double azimuth_deg) {
    const int a = static_cast<int>(std::lround(degToRad(azimuth_deg) / made.plan.azimuth_step_rad));
    return march.rangesOf(a) * march.cells.range_step_m;
  };
  EXPECT_GT(reached_m(90), 6000 - 2500);  // where the slope is seen at 3 degrees
  EXPECT_LT(reached_m(90), 6000 + 1000);
  EXPECT_GT(reached_m(270), 11.9e3);
}

// In rugged country rays must stay in the band whatever the slopes below them, else the field in sight is
// lost.
TEST(ParabolicField, EqualsFreeSpaceHighAboveRuggedGround) {
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double north) {
        return 150 + 120 * std::sin(250 * east + 1) * std::cos(200 * north);  // slopes to 24 degrees
      });
  const auto scenario = around(3e8, 500, {24e3, 24e3, 800}, {40, 40, 10});
  const auto volume = solve(scenario, terrain);
  const Made made(*scenario, terrain.get());
  std::vector<double> excess_db;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) excess_db.push_back(excessIn(*volume, made, i, j, 5));  // 440 m high
  }
  EXPECT_NEAR(quantileOf(excess_db, 0.5), 0, 2);
  EXPECT_LT(quantileOf(excess_db, 0.95), 8);
}

TEST(ParabolicField, PathsAcrossAHoleAreUnknownAndOthersAreNot) {
  const auto terrain = std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.6, 0.05);
  const auto scenario = around(3e8, 1200, {36e3, 36e3, 1000}, {24, 24, 4}, 1100);
  EXPECT_THAT(test::errorOf([&] { solve(scenario, terrain); }, ErrorCode::bad_input),
              ::testing::HasSubstr("missing"));
  FieldOptions options;
  options.allow_missing_terrain = true;
  const auto volume = solve(scenario, terrain, options);
  const auto known = std::count_if(volume->first_valid_k.begin(), volume->first_valid_k.end(),
                                   [](std::uint16_t k) { return k < 4; });
  EXPECT_GT(known, 500);
  EXPECT_LT(known, 24 * 24);
}

TEST(ParabolicField, SurfacesNearGroundEqualPaths) {
  const scenario::TerrainPtr terrain = gentleHills();
  const auto scenario = around(3e8, 180, {24e3, 24e3, 400}, {4, 4, 4}, 80);
  const auto made_surface = std::make_shared<Surface>();
  Surface& surface = *made_surface;
  surface.width = surface.height = 30;
  for (int n = 0; n < 900; ++n) {
    surface.positions.push_back(
        {kLatitude_deg - 0.1 + 0.2 * (n / 30) / 29, kLongitude_deg - 0.15 + 0.3 * (n % 30) / 29});
  }
  surface.heights_m = {3, 30, 100};
  FieldOptions options;
  options.surface = made_surface;
  const auto volume = solve(scenario, terrain, options);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  std::vector<double> differences;
  for (int n = 7; n < 900; n += 47) {
    for (int k = 0; k < 3; ++k) {
      scenario::SitePosition position;
      const auto& at = surface.positions[static_cast<std::size_t>(n)];
      const double height_msl_m = terrain->heightMsl_m(at.latitude_deg, at.longitude_deg) +
                                  surface.heights_m[static_cast<std::size_t>(k)];
      const PathBudget budget =
          pathBudget(snapshot, 0, {{at.latitude_deg, at.longitude_deg, height_msl_m}, height_msl_m},
                     PropagationModel::parabolic_equation, terrain.get());
      differences.push_back(std::abs(budget.find("power_density_dbwm2")->value -
                                     static_cast<double>(testing::valueAt(*volume, n % 30, n / 30, k))));
    }
  }
  EXPECT_LT(quantileOf(differences, 0.5), 0.8);
  EXPECT_LT(quantileOf(differences, 0.9), 4);  // nulls between hills
}

TEST(ParabolicField, TurnedBeamIsCombinedAndSettingsRepeatMarch) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto editedBy = [&](auto edit) {
    auto edited = std::make_shared<scenario::Scenario>(*scenario);
    edit(*edited);
    return solver.update(scenario::snapshotAt(edited, nullptr, 0));
  };
  EXPECT_THAT(editedBy([](auto& s) { s.emitters[0].power_w *= 2; }).moved, ::testing::IsEmpty());
  EXPECT_THAT(editedBy([](auto& s) { s.emitters[0].propagation.parabolic_equation.max_angle_deg = 2; }).moved,
              ::testing::ElementsAre(0));
  EXPECT_THAT(editedBy([](auto& s) { s.atmosphere.k_factor = 1.5; }).moved, ::testing::ElementsAre(0));
}

TEST(ParabolicField, PatternRepeatsMarchWhenBeamTiltsOnly) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  scenario::Emitter& emitter = scenario->emitters[0];
  emitter.antenna = scenario::makeSinc(20, 2, 2, -30);
  emitter.propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto movedBy = [&](auto edit) {
    auto edited = std::make_shared<scenario::Scenario>(*scenario);
    edit(edited->emitters[0]);
    return solver.update(scenario::snapshotAt(edited, nullptr, 0)).moved;
  };
  EXPECT_THAT(movedBy([](auto& e) { e.scan.azimuth_deg = 77; }), ::testing::IsEmpty());
  EXPECT_THAT(movedBy([](auto& e) { e.antenna = scenario::makeSinc(30, 2, 2, -30); }), ::testing::IsEmpty());
  EXPECT_THAT(movedBy([](auto& e) { e.scan.elevation_deg = 1; }), ::testing::ElementsAre(0));
  EXPECT_THAT(movedBy([](auto& e) { e.antenna = scenario::makeSinc(20, 2, 3, -30); }),
              ::testing::ElementsAre(0));
}

TEST(ParabolicField, DominantModelMarksMarchAndDiffraction) {
  const auto scenario = overTheSea(6000, 30);
  const auto power = solve(scenario);
  scenario->output.quantities = {"dominant_model"};
  const auto model = solve(scenario);
  const Made made(*scenario, nullptr);
  const Marched marched(made);
  const propagation::PeExcess& excess = marched.excess;
  const std::vector<std::string> labels = volume::labelsOf(model->info);
  std::map<std::string, int> seen;
  for (int i = 0; i < 160; ++i) {
    const GridColumn column = made.columns.view()[static_cast<std::size_t>(160 + i)];
    const auto range_m = static_cast<float>(footInverse(made.station, column, 0).distance_m);
    for (int k = 0; k < 30; ++k) {
      const auto height_m =
          static_cast<float>(heightMsl_m(column, static_cast<double>(made.columns.t_m[std::size_t(k)])));
      const bool is_equation = excess.others.equationPart(range_m, height_m, 0, 0) >= 0.5F;
      const std::string& name =
          labels.at(static_cast<std::size_t>(std::lround(testing::valueAt(*model, i, 1, k))));
      ++seen[name];
      const bool is_high = height_m > excess.top_m;
      EXPECT_TRUE(name != "two_ray" || !is_equation) << i << ", " << k;
      EXPECT_TRUE(name != "parabolic_equation" || (is_equation && !is_high)) << i << ", " << k;
      EXPECT_TRUE(name != "extended_optics" || (is_equation && is_high)) << i << ", " << k;
      EXPECT_TRUE(name != "troposcatter" || excessIn(*power, made, i, 1, k) > 30) << i << ", " << k;
    }
  }
  for (const char* name : {"two_ray", "parabolic_equation", "extended_optics"})
    EXPECT_GT(seen[name], 10) << name;
}

TEST(ParabolicField, DominantModelMarksScatterAndFloor) {
  const auto scenario = overTheSea(20, 5);
  scenario->output.quantities = {"dominant_model"};
  EXPECT_EQ(testing::valueAt(*solve(scenario), 0, 1, 2),
            static_cast<float>(propagation::Mechanism::troposcatter));
  scenario->output.quantities = {"power_density_dbwm2"};
  scenario->emitters[0].propagation.parabolic_equation.floor_db = -30;
  const auto power = solve(scenario);
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto asked = std::make_shared<scenario::Scenario>(*scenario);
  asked->output.quantities = {"dominant_model"};
  EXPECT_THAT(solver.update(scenario::snapshotAt(asked, nullptr, 0)).moved, ::testing::ElementsAre(0));
  const auto model = solver.volumes()[0].host();
  const Made made(*scenario, nullptr);
  EXPECT_EQ(testing::valueAt(*model, 20, 1, 2), static_cast<float>(propagation::Mechanism::floor));
  EXPECT_NEAR(excessIn(*power, made, 20, 1, 2), 30, 0.1);
  EXPECT_EQ(testing::valueAt(*model, 70, 1, 2),
            static_cast<float>(propagation::Mechanism::parabolic_equation));
}

TEST(ParabolicField, SlantPolarizationIsMeanOfBoth) {
  const auto scenario = around(3e8, 30, {20e3, 300, 200}, {40, 3, 20});
  const auto powerOf = [&](Polarization polarization) {
    scenario->emitters[0].polarization = polarization;
    return std::pow(10.0, static_cast<double>(testing::valueAt(*solve(scenario), 3, 1, 5)) / 10);
  };
  const double mean = (powerOf(Polarization::horizontal) + powerOf(Polarization::vertical)) / 2;
  EXPECT_NEAR(10 * std::log10(powerOf(Polarization::slant_45) / mean), 0, 0.02);
}

TEST(ParabolicField, ReportsChosenGrid) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  const Made made(*scenario, nullptr);
  std::string all;
  for (const propagation::ModelChoice& choice : made.plan.choices)
    all += choice.name + " " + choice.text + "\n";
  for (const char* name :
       {"largest angle 3 degrees", "height step", "range step", "absorber", "azimuths 1:", "cells", "cost"})
    EXPECT_THAT(all, ::testing::HasSubstr(name));
}

// Over terrain as many heights as a power of two below the wanted one hold, if they hold most of the angle.
TEST(ParabolicField, AngleIsReducedByAQuarterForHalfTheHeights) {
  constexpr double kMetresPerDegree = 70e3;
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return std::max(0.0, 450 - std::abs((east - 0.5) * kMetresPerDegree - 3000) * 0.18);
      });
  int halved = 0;
  for (const double frequency_hz : {4.0e9, 5.0e9, 5.5e9, 7e9}) {
    const auto scenario = around(frequency_hz, 30, {8e3, 8e3, 1000}, {8, 8, 10});
    const PePlan automatic = Made(*scenario, terrain.get()).plan;
    scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 3;
    const PePlan given = Made(*scenario, terrain.get()).plan;
    EXPECT_NEAR(given.max_angle_rad, degToRad(3.0), 1e-12);
    if (automatic.grid.intervals == given.grid.intervals) {
      EXPECT_NEAR(automatic.max_angle_rad, given.max_angle_rad, 1e-12) << frequency_hz;
      continue;
    }
    ++halved;
    EXPECT_EQ(2 * automatic.grid.intervals, given.grid.intervals) << frequency_hz;
    EXPECT_GE(automatic.max_angle_rad, degToRad(2.25)) << frequency_hz;
    EXPECT_LT(automatic.max_angle_rad, given.max_angle_rad) << frequency_hz;
  }
  EXPECT_GT(halved, 0);
  EXPECT_LT(halved, 4);
}

// The figure of duct_fields.csv: 10 to 10 m at 60 km 6.84 dB over free space in a duct of 14 m; without, deep
// behind the horizon.
TEST(ParabolicField, AnEvaporationDuctGuidesBeyondTheHorizon) {
  const auto scenario = overTheSea(20, 5);
  const auto plain = solve(scenario);
  scenario->atmosphere.refractivity = duct({14});
  const auto ducted = solve(scenario);
  const Made made(*scenario, nullptr);
  EXPECT_NEAR(-excessIn(*ducted, made, 20, 1, 2), 6.84, 1.0);
  EXPECT_LT(-excessIn(*plain, made, 20, 1, 2), -40);
}

TEST(ParabolicField, DuctsHaveNoEffectHighUpAndAtLargeAngles) {
  const auto scenario = overTheSea(6000, 30);
  const auto plain = solve(scenario);
  scenario->atmosphere.refractivity = duct({14});
  const auto ducted = solve(scenario);
  int compared = 0;
  for (int i = 0; i < 160; ++i) {
    for (int k = 10; k < 30; ++k) {
      const double height_m = 200.0 * k + 100, range_m = std::abs(i - 79.5) * 1000;
      if (height_m / range_m < std::tan(degToRad(5.0))) continue;
      ++compared;
      EXPECT_NEAR(static_cast<double>(testing::valueAt(*ducted, i, 1, k)),
                  static_cast<double>(testing::valueAt(*plain, i, 1, k)), 0.1);
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(ParabolicField, AnEnsembleHasTheMeanPowerOrAQuantile) {
  const auto scenario = overTheSea(20, 5);
  const auto valueOf = [&](const std::shared_ptr<propagation::Refractivity>& refractivity) {
    scenario->atmosphere.refractivity = refractivity;
    return static_cast<double>(testing::valueAt(*solve(scenario), 20, 1, 2));
  };
  const double low = valueOf(duct({6})), middle = valueOf(duct({10})), high = valueOf(duct({14}));
  const double mean =
      10 * std::log10((std::pow(10, low / 10) + std::pow(10, middle / 10) + std::pow(10, high / 10)) / 3);
  EXPECT_NEAR(valueOf(duct({6, 10, 14})), mean, 0.3);
  const auto one = duct({10});
  one->members.push_back(one->air);
  EXPECT_EQ(valueOf(one), middle) << "an ensemble of one";
  const auto median = duct({6, 10, 14});
  median->quantile = 0.5;
  EXPECT_NEAR(valueOf(median), middle, 0.3);
}

struct Refusal {
  const char* name;
  std::function<void(scenario::Scenario&)> edit;
  const char* message;
};

TEST(ParabolicField, RefusesInputsOutsideItsLimits) {
  const std::vector<Refusal> refusals{
      {"frequency", [](auto& s) { s.emitters[0].frequency_hz = 20e6; },
       "frequency 20 MHz is outside 30..40000"},
      {"top", [](auto& s) { s.emitters[0].propagation.parabolic_equation.top_m = 25; }, "'top_m' is 25 m"},
      {"antenna on the ground", [](auto& s) { s.platforms[0].track[0].position.height_msl_m = 0; },
       "antenna 0 m above the ground; expected above 0, up to "},
      {"step", [](auto& s) { s.emitters[0].propagation.parabolic_equation.range_step_m = 2000; },
       "'range_step_m' is 2000 m; the absorber allows at most"},
      {"distance",
       [](auto& s) {
         s.region.size_m = {2.9e6, 300, 200};
       },
       "outside 0..1000 km"},
      {"steps",
       [](auto& s) {
         s.region.size_m.x = 400e3;
         s.emitters[0].propagation.parabolic_equation.range_step_m = 5;
       },
       "is outside 1..20000"},
      {"heights",
       [](auto& s) {
         s.emitters[0].frequency_hz = 10e9;
         s.emitters[0].propagation.parabolic_equation.max_angle_deg = 15;
         s.emitters[0].propagation.parabolic_equation.top_m = 5000;
       },
       "at most 32768"},
      {"raster",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].scan = {scenario::ScanKind::raster, 0, 0, 0, 90, 30, 1.5, 3, {}};
       },
       "emitter 'tower': 'parabolic_equation': 'source' is pattern, which marches the beam at one elevation, "
       "but "
       "its raster has 3 bars, 1.5 degrees apart; expected isotropic, or a beam that stays in elevation"},
      {"dwells",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].scan.kind = scenario::ScanKind::dwell_list;
         s.emitters[0].scan.dwells = {{0, 1, 1}, {0, 2, 1}};
       },
       "its dwells are at 1 to 2 degrees"},
      {"array",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].kind = scenario::EmitterKind::radar;
         s.output.radar_look = scenario::RadarAim::target;
         s.emitters[0].antenna = scenario::makePhasedArray(20, 8, 8, 0.5, 1);
       },
       "the radar's beam follows targets"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.name);
    const auto scenario = around(1e9, 30, {20e3, 300, 200}, {20, 3, 10});
    refusal.edit(*scenario);
    EXPECT_THAT(test::errorOf([&] { solve(scenario); }, ErrorCode::bad_input),
                ::testing::HasSubstr(refusal.message));
  }
}

TEST(ParabolicField, WarnsOutsideMeasuredSettings) {
  const auto warningsOf = [](auto edit) {
    const auto scenario = around(1e9, 30, {20e3, 300, 200}, {20, 3, 10});
    edit(*scenario);
    FieldSolver solver(scenario, nullptr, {});
    solver.update(scenario::snapshotAt(scenario, nullptr, 0));
    std::string all;
    for (const std::string& warning : solver.warnings()) all += warning + "\n";
    return all;
  };
  EXPECT_EQ(warningsOf([](auto&) {}), "");
  const auto ductOver = [](propagation::GroundKind kind) {
    return [kind](auto& s) {
      s.ground.kind = kind;
      s.atmosphere.refractivity = duct({14});
    };
  };
  EXPECT_EQ(warningsOf(ductOver(propagation::GroundKind::sea)), "");
  EXPECT_THAT(warningsOf(ductOver(propagation::GroundKind::dry_ground)),
              ::testing::HasSubstr("the evaporation duct is left out over land"));
  const auto measuredTo = [](double height_m) {
    return [height_m](auto& s) {
      const auto air = std::make_shared<propagation::Refractivity>();
      air->air.profiles = {propagation::withUpperAir(
          propagation::profileOfLevels({{0, 330}, {height_m, 330 + 0.118 * height_m}}))};
      s.atmosphere.refractivity = air;
    };
  };
  EXPECT_EQ(warningsOf(measuredTo(200)), "");
  EXPECT_THAT(warningsOf(measuredTo(150)), ::testing::HasSubstr("the profile of the air ends below"));
  EXPECT_THAT(warningsOf([](auto& s) { s.emitters[0].frequency_hz = 25e9; }),
              ::testing::HasSubstr("frequency 25000 MHz is outside 30..20000 MHz"));
  EXPECT_THAT(warningsOf([](auto& s) { s.ground.roughness_m = 3; }),
              ::testing::HasSubstr("roughness (rms) 3 m"));
}

/// A radar of 1 GHz 20 m above the valley of Jacksboro, and the SRTM's ground around it.
struct Jacksboro {
  std::shared_ptr<scenario::Scenario> scenario = around(1e9, 0, {16e3, 16e3, 1200}, {80, 80, 12}, 250);
  scenario::TerrainPtr terrain;

  Jacksboro() {
    terrain = standOn("scenarios/data/jacksboro.tif", 36.303, -84.246, 20, *scenario);
    scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 6;
  }
  /// Differences (dB) where the equation speaks and the first is at most 20 dB below free space.
  template <class Edit>
  std::vector<double> differences(Edit edit) const {
    const Made made(*scenario, terrain.get());
    const auto before = solve(scenario, terrain);
    const auto edited = std::make_shared<scenario::Scenario>(*scenario);
    edit(edited->emitters[0].propagation.parabolic_equation);
    const auto after = solve(edited, terrain);
    edited->emitters[0].propagation = scenario->emitters[0].propagation;
    edited->output.quantities = {"dominant_model"};
    const auto model = solve(edited, terrain);
    std::vector<double> differences_db;
    for (int k = 0; k < 12; ++k) {
      for (int j = 0; j < 80; ++j) {
        for (int i = 0; i < 80; ++i) {
          if (k < made.columns.first_valid_k[static_cast<std::size_t>(j * 80 + i)] ||
              testing::valueAt(*model, i, j, k) !=
                  static_cast<float>(propagation::Mechanism::parabolic_equation) ||
              excessIn(*before, made, i, j, k) > 20)
            continue;
          differences_db.push_back(std::abs(
              static_cast<double>(testing::valueAt(*after, i, j, k) - testing::valueAt(*before, i, j, k))));
        }
      }
    }
    return differences_db;
  }
};

// What the choices of the march are worth over real terrain; docs/parabolic-equation.md has the figures.
TEST(ParabolicAblation, OfAzimuthsAndOfCells) {
  const Jacksboro jacksboro;
  const auto azimuths = jacksboro.differences([](auto& settings) { settings.azimuths = 1188; });
  const auto fewer = jacksboro.differences([](auto& settings) { settings.azimuths = 200; });
  const auto points =
      jacksboro.differences([](auto& settings) { settings.cells = propagation::PeCells::point; });
  ASSERT_GT(azimuths.size(), 5000u);
  recordDifferences("1188 azimuths in place of the automatic ones", azimuths);
  recordDifferences("200 azimuths in place of the automatic ones", fewer);
  recordDifferences("points in place of means", points);
  RecordProperty("automatic azimuths", Made(*jacksboro.scenario, jacksboro.terrain.get()).plan.azimuths);
  EXPECT_LT(quantileOf(azimuths, 0.5), quantileOf(fewer, 0.5));
  EXPECT_LT(quantileOf(azimuths, 0.5), quantileOf(points, 0.5));
}

TEST(ParabolicAblation, OfTheNarrowFormOverTerrain) {
  const Jacksboro jacksboro;
  const Made made(*jacksboro.scenario, jacksboro.terrain.get());
  std::vector<double> in_sight, in_shadow;
  for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 30) {
    propagation::RadialPath path;
    path.source.height_agl_m = 20;
    path.surface = made.plan.surfaces[0];
    path.air = made.plan.air[0][0];
    const double step_m = made.plan.grid.range_step_m;
    constexpr int kSteps = 90;
    std::vector<float> ground_msl_m(kSteps + 1);
    made.radials.ground(degToRad(static_cast<double>(azimuth_deg)), kSteps * step_m, step_m, kSteps + 1,
                        ground_msl_m.data());
    path.ground_msl_m.assign(ground_msl_m.begin(), ground_msl_m.end());
    propagation::MarchGrid narrow_grid = made.plan.grid;
    narrow_grid.form = propagation::PeForm::narrow;
    propagation::RadialMarch<double, 1> wide(made.plan.grid, {path}), narrow(narrow_grid, {path});
    for (int step = 1; step <= kSteps; ++step) {
      wide.advance();
      narrow.advance();
      if (step < 20 || step % 5 != 0) continue;
      for (double height_m = 5; height_m < 200; height_m += 15) {
        const double factor_db = wide.factorDb(0, height_m);
        if (factor_db < -40) continue;
        (factor_db > -10 ? in_sight : in_shadow)
            .push_back(std::abs(narrow.factorDb(0, height_m) - factor_db));
      }
    }
  }
  recordDifferences("narrow form in sight", in_sight);
  recordDifferences("narrow form in shadow", in_shadow);
  EXPECT_GT(quantileOf(in_shadow, 0.5), 0.1);
}

// The angle at which the surface's reflection is exact: that of the duct's critical ray against 0.3 degrees.
TEST(ParabolicAblation, OfTheGrazingAngleInADuct) {
  for (const double frequency_hz : {1e9, 3e9, 10e9}) {
    std::vector<double> differences_db;
    propagation::RadialPath path;
    path.source.height_agl_m = 15;
    path.air = propagation::evaporationDuct(20);
    path.surface.polarization = propagation::LinearPolarization::vertical;
    path.surface.perfect = false;
    path.surface.ground = {70, 5};
    propagation::RadialPath critical = path;
    const propagation::RefractivityProfile air = path.air.at(0);
    critical.surface.grazing_rad = std::sqrt(2e-6 * (air.at(0) - air.at(20)));
    propagation::MarchNeeds needs;
    needs.frequency_hz = frequency_hz;
    needs.max_height_m = 200;
    needs.max_angle_rad = degToRad(1.5);
    needs.traps = true;
    const propagation::MarchGrid grid = propagation::automaticGrid(needs).grid;
    propagation::RadialMarch<double, 1> fixed_angle(grid, {path}), critical_angle(grid, {critical});
    while (fixed_angle.range_m() < 100e3) {
      fixed_angle.advance();
      critical_angle.advance();
      if (fixed_angle.range_m() < 20e3) continue;
      for (double height_m = 5; height_m < 60; height_m += 5) {
        const double factor_db = fixed_angle.factorDb(0, height_m);
        if (factor_db > -20)
          differences_db.push_back(std::abs(critical_angle.factorDb(0, height_m) - factor_db));
      }
    }
    recordDifferences("critical angle at " + std::to_string(frequency_hz / 1e9) + " GHz", differences_db);
    EXPECT_LT(quantileOf(differences_db, 0.9), 1) << frequency_hz;
  }
}

// An antenna above the heights that are wanted raises the domain.
TEST(ParabolicField, HoldsAnAntennaAboveTheField) {
  const auto scenario = around(1e9, 3000, {20e3, 300, 200}, {20, 3, 10});
  EXPECT_GT(Made(*scenario, nullptr).plan.top_m, 3000);
  const auto volume = solve(scenario);
  for (const float power_dbwm2 : volume->values) EXPECT_TRUE(std::isfinite(power_dbwm2));
}

// Planes hold the field over free space: power is a factor in the combination, and over a smooth earth all
// azimuths are one.
TEST(ParabolicField, DoesNotDependOnPowerAndAzimuth) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {21, 21, 10});
  const auto volume = solve(scenario);
  for (const int i : {0, 3, 8}) {
    for (int k = 0; k < 10; ++k) {
      const float west = testing::valueAt(*volume, i, 10, k), south = testing::valueAt(*volume, 10, i, k);
      EXPECT_NEAR(west, testing::valueAt(*volume, 20 - i, 10, k), 0.02) << i << ", " << k;
      EXPECT_NEAR(west, south, 0.1) << i << ", " << k;  // the earth is not a sphere
    }
  }
  scenario->emitters[0].power_w *= 100;
  const auto stronger = solve(scenario);
  for (std::size_t v = 0; v < volume->values.size(); ++v)
    EXPECT_NEAR(stronger->values[v] - volume->values[v], 20, 0.01);
}

TEST(ParabolicField, WarnsOfAnAntennaInAValley) {
  const auto warningsWith = [](double max_angle_deg) {
    const auto crater = std::make_shared<const MadeTerrain>(
        kLatitude_deg, kLongitude_deg, 0.4,
        [](double east, double north) { return std::hypot(east - 0.2, north - 0.2) > 0.03 ? 500.0 : 100.0; });
    const auto scenario = around(3e8, 110, {20e3, 20e3, 400}, {20, 20, 4}, 520);
    scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = max_angle_deg;
    FieldSolver solver(scenario, crater, {});
    solver.update(scenario::snapshotAt(scenario, crater.get(), 0));
    return solver.warnings();
  };
  const auto behind = ::testing::Contains(::testing::HasSubstr("a larger 'max_angle_deg' reaches further"));
  EXPECT_THAT(warningsWith(3), behind);
  EXPECT_THAT(warningsWith(12), ::testing::Not(behind));
}

TEST(ParabolicField, CountsGroundThatIsTooSteep) {
  const auto terrain = std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.4, [](double east, double) { return east > 0.3 ? 400.0 : 100.0; });
  const auto scenario = around(3e8, 200, {20e3, 2e3, 400}, {20, 3, 4}, 420);
  FieldSolver solver(scenario, terrain, {});
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0));
  EXPECT_THAT(solver.warnings(), ::testing::Contains(::testing::HasSubstr("taken as steps of a staircase")));
}

}  // namespace
}  // namespace emscape::emfield
