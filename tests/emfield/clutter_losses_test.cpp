// Losses by trees and buildings: the statistic of P.2108 at the ends of paths, and heights along them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "emfield/excess/clutter_text.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/model_check.h"
#include "emfield/ground/ground_posts.h"
#include "emfield/link/path_verdict.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/emfield/link/path_budget.h"
#include "propagation/normal_deviate.h"
#include "propagation/p2108/p2108.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;
using propagation::TerminalClutterModel;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

double lossOf(double frequency_ghz, double distance_m, double percent) {
  return propagation::p2108LossDb(frequency_ghz, distance_m, -propagation::normalDeviate(percent / 100));
}

TEST(TerminalClutter, MeetsTheRecommendationsOwnFigures) {
  // Of the spreadsheet of ITU-R Study Group 3 for P.2108, section 3.2, at 0.65 km; rounded to 0.1 dB.
  const double percents[] = {5, 50, 95, 99.9};
  const struct {
    double frequency_ghz, loss_db[4];
  } rows[] = {{2, {19.2, 27.1, 34.6, 40.4}},  {3, {20.0, 28.3, 36.3, 42.1}},  {5, {20.8, 29.6, 38.3, 44.2}},
              {10, {21.7, 30.6, 39.5, 45.3}}, {30, {23.1, 31.5, 39.6, 45.4}}, {66, {23.9, 31.9, 39.6, 45.4}}};
  for (const auto& row : rows) {
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(lossOf(row.frequency_ghz, 650, percents[i]), row.loss_db[i], 0.0501)
          << row.frequency_ghz << " GHz, " << percents[i] << " %";
  }
}

TEST(TerminalClutter, GrowsUpToTwoKilometresAndWithThePercentageOfLocations) {
  EXPECT_LT(lossOf(1, 300, 50), lossOf(1, 1000, 50));
  EXPECT_EQ(lossOf(1, 2000, 50), lossOf(1, 50e3, 50));
  EXPECT_LT(lossOf(1, 5e3, 10), lossOf(1, 5e3, 90));
  EXPECT_NEAR(double(propagation::p2108LossDb(0.868f, 9e3f, 0.0f)), lossOf(0.868, 9e3, 50), 1e-4);
}

TEST(TerminalClutter, IsAtLowEndsWithinTheDistancesOfTheRecommendation) {
  propagation::TerminalClutter clutter;
  EXPECT_EQ(clutter.lossDb(5000, 1), 0) << "none";
  clutter.frequency_ghz = 1;
  clutter.below_m = 10;
  EXPECT_EQ(clutter.ends(249, 1), 0);
  EXPECT_EQ(clutter.ends(251, 1), 1);
  EXPECT_EQ(clutter.ends(5000, 10.5f), 0) << "above the clutter";
  clutter.at_transmitter = true;
  EXPECT_EQ(clutter.ends(999, 1), 1) << "one end below 1 km";
  EXPECT_EQ(clutter.ends(1000, 1), 2);
  EXPECT_EQ(clutter.ends(1000, 100), 1);
  EXPECT_FLOAT_EQ(clutter.lossDb(5000, 1), 2 * clutter.lossDb(5000, 100));
}

/// Flat ground with a wood 15 m high from 2 km to 3 km north of the emitter, or all over it.
class GroundWithTrees : public MadeTerrain {
 public:
  explicit GroundWithTrees(bool is_everywhere)
      : MadeTerrain(45, 5, 0.2, [](double, double) { return 100.0; }),
        with_trees_(45, 5, 0.2, [=](double, double north_deg) {
          const double north_m = (north_deg - 0.1) * 111.1e3;
          return is_everywhere || (north_m > 2000 && north_m < 3000) ? 115.0 : 100.0;
        }) {}
  scenario::TerrainView view() const override {
    scenario::TerrainView view = MadeTerrain::view();
    surface_ = with_trees_.view().rasters;
    view.surfaces = surface_;
    view.surface_count = 1;
    return view;
  }

 private:
  MadeTerrain with_trees_;
  mutable const scenario::TerrainRaster* surface_ = nullptr;
};

std::shared_ptr<scenario::Scenario> mastOf(PropagationModel model, double height_agl_m) {
  auto scenario = emptyScenario(FrameKind::altitude, 45, 5, {15e3, 15e3, 1e3}, {8, 8, 16});
  scenario->terrain = scenario::TerrainSpec{};
  scenario::Emitter emitter = plainEmitter("mast", 0);
  emitter.propagation.model = model;
  addEmitter(*scenario, {45, 5, 0}, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_agl_m = height_agl_m;
  return scenario;
}

PathBudget budgetTo(const std::shared_ptr<scenario::Scenario>& scenario, const scenario::Terrain& terrain,
                    double latitude_deg, double height_msl_m) {
  return pathBudget(scenario::snapshotAt(scenario, &terrain, 0), 0,
                    {{latitude_deg, 5, height_msl_m + geoidUndulation_m(latitude_deg, 5)}, height_msl_m},
                    scenario->emitters[0].propagation.model, &terrain);
}

TEST(ClutterHeights, OfAWoodOnThePathCostDiffractionAndAreATermOfTheBudget) {
  const GroundWithTrees wood(false);
  const MadeTerrain bare(45, 5, 0.2, [](double, double) { return 100.0; });
  for (const PropagationModel model : {PropagationModel::diffraction, PropagationModel::itm,
                                       PropagationModel::p1812, PropagationModel::p452}) {
    const auto scenario = mastOf(model, 10);
    const PathBudget over_trees = budgetTo(scenario, wood, 45.045, 102);
    const PathBudget over_ground = budgetTo(scenario, bare, 45.045, 102);
    ASSERT_NE(over_trees.find("clutter_db"), nullptr) << toString(model);
    EXPECT_LT(over_trees.find("clutter_db")->value, -3) << toString(model);
    EXPECT_EQ(over_ground.find("clutter_db"), nullptr) << toString(model);
    EXPECT_GT(over_trees.excess.loss_db, over_ground.excess.loss_db + 3) << toString(model);
    EXPECT_NEAR(over_trees.excess.clutter_db, -over_trees.find("clutter_db")->value, 1e-9);
    EXPECT_THAT(over_trees.verdict, HasSubstr("dB of it by trees and buildings")) << toString(model);
    EXPECT_THAT(pathVerdictOf(over_trees), HasSubstr("dB of it by trees and buildings")) << toString(model);
  }
}

TEST(ClutterHeights, ByItmThatAreFarFromThoseByEdgesAreTold) {
  const GroundWithTrees woods(true);
  int told = 0;
  for (const double end_agl_m : {5.0, 9.0, 10.0, 12.0, 14.5, 30.0}) {
    const PathBudget by_itm = budgetTo(mastOf(PropagationModel::itm, 20), woods, 45.027, 100 + end_agl_m),
                     by_edges =
                         budgetTo(mastOf(PropagationModel::diffraction, 20), woods, 45.027, 100 + end_agl_m);
    const bool is_far = std::abs(by_itm.excess.clutter_db - by_edges.excess.clutter_db) > 10;
    told += is_far ? 1 : 0;
    const auto warnings = std::count_if(by_itm.warnings.begin(), by_itm.warnings.end(), [](const auto& text) {
      return text.find("trees and buildings on the path cost") != std::string::npos;
    });
    EXPECT_EQ(warnings, is_far ? 1 : 0) << end_agl_m;
  }
  EXPECT_GT(told, 0);
  EXPECT_LT(told, 6);
}

TEST(ClutterHeights, ThatBlockAPathAreAnObstacleWithPlaceAndHeightForModelsThatReadThem) {
  const GroundWithTrees wood(false);
  for (const PropagationModel model : {PropagationModel::diffraction, PropagationModel::itm,
                                       PropagationModel::p1812, PropagationModel::p452}) {
    const PathBudget budget = budgetTo(mastOf(model, 5), wood, 45.045, 105);
    ASSERT_EQ(budget.obstacles.size(), 1u) << toString(model);
    const PathObstacle& trees = budget.obstacles[0];
    EXPECT_TRUE(trees.is_cover && trees.decides && !trees.is_earth_bulge);
    EXPECT_NEAR(trees.cover_m, 15, 0.1);
    EXPECT_NEAR(trees.ground_msl_m, 100, 0.1);
    EXPECT_GT(trees.range_m, 1980);
    EXPECT_LT(trees.range_m, 3020);
    EXPECT_NEAR(trees.clearance_m, -10, 0.7) << "the earth's bulge is below 0.4 m";
    EXPECT_THAT(budget.verdict,
                ::testing::MatchesRegex("Blocked: ground cover 15 m high .trees or buildings. at "
                                        "[23].. km is 1[01] m above the ray .*"))
        << toString(model);
    EXPECT_EQ(budget.profile.cover_m.size(), budget.profile.ranges_m.size());
  }
  for (const PropagationModel model : {PropagationModel::free_space, PropagationModel::horizon}) {
    const PathBudget budget = budgetTo(mastOf(model, 5), wood, 45.045, 105);
    EXPECT_THAT(budget.profile.cover_m, IsEmpty()) << toString(model);
    EXPECT_THAT(budget.verdict, HasSubstr("Grazing: the terrain at 2.")) << toString(model);
  }
}

TEST(ClutterHeights, OfOneHeightAlongThePathAreObstacles) {
  const MadeTerrain bare(45, 5, 0.2, [](double, double) { return 100.0; });
  const auto scenario = mastOf(PropagationModel::p1812, 5);
  scenario->emitters[0].propagation.p1812.clutter_height_m = 12;
  const PathBudget budget = budgetTo(scenario, bare, 45.045, 105);
  EXPECT_THAT(budget.verdict,
              ::testing::StartsWith("Blocked: ground cover 12 m high (trees or buildings) at "));
  EXPECT_EQ(budget.profile.cover_m.front(), 0) << "around the antenna";
}

TEST(ClutterHeights, OfAnEarlierBudgetAreReused) {
  const GroundWithTrees wood(false);
  const auto scenario = mastOf(PropagationModel::p1812, 5);
  const PathEnd end{{45.045, 5, 105 + geoidUndulation_m(45.045, 5)}, 105};
  const auto budgetAt = [&](double t_s, const PathBudget* earlier) {
    return powerBudget(scenario::snapshotAt(scenario, &wood, t_s), 0, end, PropagationModel::p1812, &wood,
                       earlier);
  };
  const PathBudget first = budgetAt(0, nullptr), second = budgetAt(1, &first), third = budgetAt(2, &second);
  EXPECT_EQ(third.verdict, budgetAt(2, nullptr).verdict);
  EXPECT_EQ(third.excess.loss_db, first.excess.loss_db);
  EXPECT_EQ(third.profile.ranges_m, first.profile.ranges_m);
  EXPECT_TRUE(third.obstacles.at(0).is_cover);
}

TEST(ClutterHeights, AreAddedFromFiftyMetresOfTheEndsOn) {
  const double range_m[] = {0, 20, 49, 50, 500, 949, 950, 951, 1000};
  const float cover_m[] = {15, 15, 15, 15, NAN, 15, 15, 15, 15};
  const float ground_m[] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  float raised_m[9];
  const propagation::TerrainProfile raised = raiseByClutter({range_m, ground_m, 9, cover_m}, raised_m);
  EXPECT_THAT(raised_m, ::testing::ElementsAre(1, 1, 1, 16, 1, 16, 16, 1, 1));
  EXPECT_EQ(raised.height_msl_m, raised_m);
  EXPECT_EQ(raised.ground_msl_m(), ground_m);
}

/// The excess of a surface at a height above ground along the meridian of the mast.
std::vector<float> excessOfSurface(const std::shared_ptr<scenario::Scenario>& scenario,
                                   const scenario::TerrainPtr& terrain, const std::vector<double>& latitudes,
                                   double height_agl_m, Backend backend) {
  FieldOptions options;
  options.backend = backend;
  auto surface = std::make_shared<Surface>();
  surface->width = static_cast<int>(latitudes.size());
  surface->height = 1;
  for (const double latitude_deg : latitudes) surface->positions.push_back({latitude_deg, 5});
  surface->reference = HeightReference::ground;
  surface->heights_m = {height_agl_m};
  options.surface = surface;
  FieldSolver solver(scenario, terrain, options);
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0), terrain);
  const auto values = solver.volumes().front().host();
  return {values->values.begin(), values->values.end()};
}

class ClutterInFields : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(ClutterInFields);

TEST_P(ClutterInFields, AlongPathsAndAtTheirEndsEqualsThatOfPaths) {
  const std::vector<double> latitudes{45.003, 45.02, 45.03, 45.06};
  const scenario::TerrainPtr grounds[] = {
      std::make_shared<GroundWithTrees>(false), std::make_shared<GroundWithTrees>(true),
      std::make_shared<MadeTerrain>(45, 5, 0.2, [](double, double north_deg) {
        return north_deg > 0.122 && north_deg < 0.128 ? 160.0 : 100.0;
      })};
  for (const scenario::TerrainPtr& ground : grounds) {
    for (const PropagationModel model :
         {PropagationModel::free_space, PropagationModel::horizon, PropagationModel::diffraction,
          PropagationModel::two_ray, PropagationModel::itm, PropagationModel::p1812}) {
      for (const char* const terminal : {"none", "sum", "larger"}) {
        const bool with_terminal = terminal != std::string("none");
        const auto scenario = mastOf(model, 30);
        if (terminal == std::string("larger"))
          scenario->ground.terminal_clutter_combine = propagation::ClutterCombination::larger;
        scenario->ground.terminal_clutter =
            with_terminal ? TerminalClutterModel::p2108 : TerminalClutterModel::none;
        const std::vector<float> field = excessOfSurface(scenario, ground, latitudes, 3, GetParam());
        for (std::size_t i = 0; i < latitudes.size(); ++i) {
          const PathBudget budget = budgetTo(scenario, *ground, latitudes[i], 103);
          const double expected_db =
              std::max(budget.find("power_density_dbwm2")->value, -300.0);  // the floor
          EXPECT_NEAR(double(field[i]), expected_db, 0.1)
              << toString(model) << " at " << latitudes[i] << ", terminal clutter: " << terminal;
          EXPECT_EQ(budget.find("terminal_clutter_db") != nullptr, with_terminal);
        }
      }
    }
  }
}

/// Hills with woods 20 m high in squares of about 400 m, in cells of about 30 m.
class WoodedHills : public MadeTerrain {
 public:
  WoodedHills() : MadeTerrain(45, 5, 0.3), cells_(kCells * kCells) {
    constexpr int kSquare = 13;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i)
        cells_[j * kCells + i] = static_cast<std::uint8_t>((i / kSquare + j / kSquare) % 2);
  }
  scenario::TerrainView view() const override {
    scenario::TerrainView view = MadeTerrain::view();
    constexpr double kPerRad = kCells / degToRad(0.3);
    view.cover = {cells_.data(), kCells,   kCells, degToRad(44.85), degToRad(4.85), kPerRad,
                  kPerRad,       kClasses, 2};
    return view;
  }

 private:
  static constexpr int kCells = 1080;
  static constexpr scenario::CoverValues kClasses[2] = {{true, 0, scenario::CoverZone::land},
                                                        {true, 20, scenario::CoverZone::land}};
  std::vector<std::uint8_t> cells_;
};

/// The power density at a place, from a mast at another.
double fieldBetween(PropagationModel model, const Surface::Position& from, double from_agl_m,
                    const Surface::Position& to, double to_agl_m, const scenario::TerrainPtr& terrain,
                    Backend backend) {
  const auto scenario = mastOf(model, from_agl_m);
  scenario::SitePosition& mast = scenario->platforms[0].track[0].position;
  mast.latitude_deg = from.latitude_deg;
  mast.longitude_deg = from.longitude_deg;
  FieldOptions options;
  options.backend = backend;
  auto surface = std::make_shared<Surface>();
  surface->width = surface->height = 1;
  surface->positions = {to};
  surface->reference = HeightReference::ground;
  surface->heights_m = {to_agl_m};
  options.surface = surface;
  FieldSolver solver(scenario, terrain, options);
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0), terrain);
  return double(solver.volumes().front().host()->values[0]);
}

TEST_P(ClutterInFields, OfAPathBackIsThatOfThePath) {
  const auto terrain = std::make_shared<WoodedHills>();
  for (const PropagationModel model : {PropagationModel::diffraction, PropagationModel::itm,
                                       PropagationModel::p1812, PropagationModel::p452}) {
    std::mt19937 random(7);
    const auto within = [&](double from, double to) {
      return std::uniform_real_distribution<double>(from, to)(random);
    };
    std::vector<double> differences_db;
    for (int path = 0; path < 30; ++path) {
      const double azimuth_rad = within(0, 2 * kPi), range_m = within(1500, 8000);
      const Surface::Position a{within(44.95, 45.05), within(4.95, 5.05)};
      const GeodeticPosition end = geodesicDirect(a.latitude_deg, a.longitude_deg, azimuth_rad, range_m);
      const Surface::Position b{end.latitude_deg, end.longitude_deg};
      const double there = fieldBetween(model, a, 30, b, 10, terrain, GetParam());
      const double back = fieldBetween(model, b, 10, a, 30, terrain, GetParam());
      differences_db.push_back(std::abs(there - back));
    }
    std::sort(differences_db.begin(), differences_db.end());
    EXPECT_LT(differences_db[26], 1) << toString(model);
    // One path of itm passes the corner of a wood, which its evenly spaced profile has or misses.
    EXPECT_LT(differences_db[model == PropagationModel::itm ? 28 : 29], 3) << toString(model);
  }
}

TEST_P(ClutterInFields, OfOneHeightHasNoStepsAlongAPath) {
  for (const PropagationModel model : {PropagationModel::p1812, PropagationModel::p452}) {
    const auto scenario = mastOf(model, 30);
    scenario->terrain.reset();
    for (auto* const settings :
         {static_cast<propagation::ClearAirSettings*>(&scenario->emitters[0].propagation.p1812),
          static_cast<propagation::ClearAirSettings*>(&scenario->emitters[0].propagation.p452)}) {
      settings->clutter_height_m = 20;
      settings->zone = propagation::ClearAirZone::inland;
    }
    std::vector<double> latitudes;  // steps of 5 m, from 2.2 km on
    for (int n = 0; n < 240; ++n) latitudes.push_back(45.02 + n * 5 / 111.1e3);
    const std::vector<float> field = excessOfSurface(scenario, nullptr, latitudes, 10, GetParam());
    for (std::size_t n = 1; n < field.size(); ++n)
      EXPECT_NEAR(field[n], field[n - 1], 0.3) << toString(model) << ", " << n;
    const PathBudget budget =
        pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0,
                   {{latitudes[100], 5, 10 + geoidUndulation_m(latitudes[100], 5)}, 10}, model, nullptr);
    EXPECT_NEAR(double(field[100]), budget.find("power_density_dbwm2")->value, 0.1) << toString(model);
  }
}

TEST(TerminalClutter, IsAddedOrReplacesASmallerLossByTerrain) {
  // Hills of 200 m hide the farther places, each more than the one before.
  const MadeTerrain hills(45, 5, 0.2, [](double, double north_deg) {
    return 100 + (north_deg > 0.115 && north_deg < 0.125   ? 5
                  : north_deg > 0.145 && north_deg < 0.155 ? 200
                                                           : 0);
  });
  const auto scenario = mastOf(PropagationModel::diffraction, 12);
  const auto lossAt = [&](double latitude_deg) {
    return budgetTo(scenario, hills, latitude_deg, 102).excess.loss_db;
  };
  for (const double latitude_deg : {45.005, 45.018, 45.03, 45.06}) {
    scenario->ground.terminal_clutter = TerminalClutterModel::none;
    const double by_terrain_db = lossAt(latitude_deg);
    scenario->ground.terminal_clutter = TerminalClutterModel::p2108;
    scenario->ground.terminal_clutter_combine = propagation::ClutterCombination::sum;
    const double clutter_db = lossOf(1, (latitude_deg - 45) * 111.1e3, 50);
    EXPECT_NEAR(lossAt(latitude_deg), by_terrain_db + clutter_db, 0.02);
    const auto isWarned = [&] {
      const std::vector<std::string> all = budgetTo(scenario, hills, latitude_deg, 102).excess.warnings;
      return std::any_of(all.begin(), all.end(), [](const std::string& warning) {
        return warning.find("terminal_clutter_combine: larger") != std::string::npos;
      });
    };
    EXPECT_EQ(isWarned(), by_terrain_db > 6) << by_terrain_db;
    if (latitude_deg < 45.01) {
      EXPECT_LT(by_terrain_db, 1) << "the loss of P.2108-1 is none by terrain";
    }
    scenario->ground.terminal_clutter_combine = propagation::ClutterCombination::larger;
    EXPECT_NEAR(lossAt(latitude_deg), std::max(by_terrain_db, clutter_db), 0.02);
    EXPECT_FALSE(isWarned());
  }
}

// Whether an antenna is in the clutter follows from its height, not from who transmits.
TEST(TerminalClutter, IsThatOfTheSameEndsWhoeverTransmits) {
  const MadeTerrain flat(45, 5, 0.2, [](double, double) { return 100.0; });
  const auto lossOver = [&](double from_agl_m, double to_agl_m) {
    const auto scenario = mastOf(PropagationModel::free_space, from_agl_m);
    scenario->ground.terminal_clutter = TerminalClutterModel::p2108;
    return budgetTo(scenario, flat, 45.04, 100 + to_agl_m).excess.loss_db;
  };
  const double one_end_db = lossOf(1, 4444, 50);
  for (const auto& [low_m, high_m, ends] :
       {std::tuple{1.5, 25.0, 1}, {10.0, 30.0, 1}, {10.5, 25.0, 0}, {1.5, 9.0, 2}}) {
    EXPECT_NEAR(lossOver(low_m, high_m), ends * one_end_db, 0.02) << low_m << " to " << high_m;
    EXPECT_NEAR(lossOver(high_m, low_m), ends * one_end_db, 0.02) << high_m << " to " << low_m;
  }
}

TEST(TerminalClutter, OfALowRadarIsInItsEchoesAsInItsJamming) {
  auto scenario = emptyScenario(FrameKind::altitude, 45, 5, {30e3, 30e3, 6e3}, {8, 8, 16});
  scenario::Emitter radar = plainEmitter("radar", 0), jammer = plainEmitter("jammer", 0);
  radar.kind = scenario::EmitterKind::radar;
  radar.scan.kind = scenario::ScanKind::track;
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.power_w = 1e-6;
  addEmitter(*scenario, {45, 5, 0}, radar);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  addEmitter(*scenario, {45, 5.2, 3000 + geoidUndulation_m(45, 5.2)}, jammer);
  const auto at = [&](double radar_agl_m, TerminalClutterModel clutter) {
    scenario->platforms[0].track[0].position.height_agl_m = radar_agl_m;
    scenario->ground.terminal_clutter = clutter;
    return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0,
                      {{45.1, 5, 1000 + geoidUndulation_m(45.1, 5)}, 1000}, PropagationModel::free_space,
                      nullptr);
  };
  const double loss_db = lossOf(1, 11e3, 50);  // of all distances beyond 2 km
  for (const double radar_agl_m : {8.0, 12.0}) {
    const PathBudget open = at(radar_agl_m, TerminalClutterModel::none),
                     town = at(radar_agl_m, TerminalClutterModel::p2108);
    const auto change_db = [&](const char* key) { return town.find(key)->value - open.find(key)->value; };
    const double expected_db = radar_agl_m < 10 ? loss_db : 0;
    EXPECT_NEAR(change_db("snr_db"), -2 * expected_db, 0.01) << radar_agl_m;
    EXPECT_NEAR(change_db("jammer_to_signal_db"), expected_db, 0.01) << "the echo passes it twice";
  }
}

TEST(TerminalClutter, OverASmoothEarthIsToldAsClutterBesideTheEarthsBulge) {
  const auto scenario = mastOf(PropagationModel::diffraction, 2);
  scenario->terrain.reset();
  scenario->ground.terminal_clutter = TerminalClutterModel::p2108;
  const PathBudget budget =
      pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0,
                 {{45.1, 5, 2 + geoidUndulation_m(45.1, 5)}, 2}, PropagationModel::diffraction, nullptr);
  EXPECT_THAT(budget.excess.warnings, Contains(AllOf(HasSubstr("the smooth earth costs "),
                                                     HasSubstr(" of P.2108-1 are added to it for clutter "
                                                               "around both ends"))));
}

TEST(TerminalClutter, AddsNothingToAFieldThatTerrainEnds) {
  const MadeTerrain hill(45, 5, 0.2, [](double, double north_deg) {
    return north_deg > 0.115 && north_deg < 0.125 ? 300.0 : 100.0;
  });
  const auto scenario = mastOf(PropagationModel::horizon, 10);
  scenario->ground.terminal_clutter = TerminalClutterModel::p2108;
  for (const auto combine : {propagation::ClutterCombination::sum, propagation::ClutterCombination::larger}) {
    scenario->ground.terminal_clutter_combine = combine;
    const PathBudget budget = budgetTo(scenario, hill, 45.06, 102);
    EXPECT_FALSE(std::isnan(budget.excess.clutter_db));
    EXPECT_EQ(budget.excess.loss_db, INFINITY);
    EXPECT_THAT(budget.verdict, Not(HasSubstr("trees")));
  }
}

TEST(ClutterText, NamesWhatTheLossesInclude) {
  auto scenario = mastOf(PropagationModel::diffraction, 10);
  scenario::Emitter& emitter = scenario->emitters[0];
  EXPECT_EQ(clutterText(*scenario), "none");
  scenario->ground.terminal_clutter = TerminalClutterModel::p2108;
  EXPECT_THAT(clutterText(*scenario), HasSubstr("P.2108-1 (3.2) at ends up to 10 m above the ground, 50 %"));
  scenario->ground.terminal_clutter_combine = propagation::ClutterCombination::larger;
  EXPECT_THAT(clutterText(*scenario),
              HasSubstr("50 % of locations, or the loss by terrain if that is larger"));
  EXPECT_THAT(clutterWarnings(*scenario, emitter), IsEmpty());
  scenario->ground.kind = propagation::GroundKind::sea;
  EXPECT_THAT(clutterWarnings(*scenario, emitter),
              Contains(HasSubstr("P.2108-1 is for towns and suburbs, but the 'kind' of 'ground' is sea")));
  scenario->ground.kind = propagation::GroundKind::average_ground;
  emitter.frequency_hz = 100e6;
  EXPECT_EQ(clutterText(*scenario), "none");
  EXPECT_THAT(clutterWarnings(*scenario, emitter),
              Contains(HasSubstr("frequency 0.1 GHz is outside 0.5..67")));
  emitter.frequency_hz = 1e9;
  scenario->terrain->surface_files = {"dsm.tif"};
  EXPECT_EQ(clutterText(*scenario), "heights of the surface model along the path");
  EXPECT_THAT(clutterWarnings(*scenario, emitter), Contains(HasSubstr("the terrain has a map of clutter")));
  emitter.propagation.model = PropagationModel::free_space;
  EXPECT_THAT(clutterText(*scenario), HasSubstr("none ('free_space' does not use"));
  scenario->terrain->surface_files.clear();
  scenario->ground.terminal_clutter = TerminalClutterModel::none;
  emitter.propagation.model = PropagationModel::p1812;
  emitter.propagation.p1812.clutter_height_m = 12;
  EXPECT_EQ(clutterText(*scenario), "12 m high along the path");
  scenario->emitters.push_back(emitter);
  scenario->emitters[1].name = "other";
  scenario->emitters[1].propagation.model = PropagationModel::free_space;
  EXPECT_EQ(clutterText(*scenario), "'mast': 12 m high along the path; 'other': none");
  scenario->emitters.pop_back();
  scenario->emitters[0].propagation = {};
  scenario->emitters[0].clutter.emplace();
  EXPECT_EQ(clutterText(*scenario), "none along the paths; radars with echoes of clutter: 'mast'");
}

TEST(SmoothSurface, WarnsOfPointsBelowItAndOfTerrainThatTwoRayIgnores) {
  const MadeTerrain hill(45, 5, 0.2,
                         [](double, double north_deg) { return north_deg < 0.11 ? 300.0 : 100.0; });
  const PathBudget budget = budgetTo(mastOf(PropagationModel::two_ray, 10), hill, 45.05, 105);
  EXPECT_THAT(budget.warnings,
              Contains(HasSubstr("the point is 195 m below the smooth surface of 'two_ray'")));
  EXPECT_THAT(budget.warnings, Contains(HasSubstr("is for water and other smooth ground")));
  const PathBudget by_p528 = budgetTo(mastOf(PropagationModel::p528, 10), hill, 45.05, 105);
  EXPECT_THAT(by_p528.warnings, Contains(HasSubstr("below the smooth surface of 'p528'")));
}

/// What validate, maps and fields tell; a path tells it of its end.
TEST(SmoothSurface, WarnsOfGroundFarBelowIt) {
  for (const PropagationModel model : {PropagationModel::two_ray, PropagationModel::p528}) {
    const auto scenario = mastOf(model, 10);
    const auto warningsOver = [&](double inland_m) {
      const MadeTerrain coast(45, 5, 0.2,
                              [=](double, double north_deg) { return north_deg < 0.11 ? inland_m : 0.0; });
      return smoothSurfaceWarnings(*scenario, scenario->emitters[0], coast);
    };
    EXPECT_THAT(warningsOver(300), ElementsAre(AllOf(HasSubstr("is the ground below the emitter, 300 m"),
                                                     HasSubstr("the lowest ground is at 0 m"),
                                                     HasSubstr("'ground: {surface_msl_m: 0}' sets"))));
    EXPECT_THAT(warningsOver(10), IsEmpty());
    scenario->ground.surface_msl_m = 0;  // the remedy
    EXPECT_THAT(warningsOver(300), IsEmpty());
  }
  const auto other = mastOf(PropagationModel::diffraction, 10);
  const MadeTerrain coast(45, 5, 0.2,
                          [](double, double north_deg) { return north_deg < 0.11 ? 300.0 : 0.0; });
  EXPECT_THAT(smoothSurfaceWarnings(*other, other->emitters[0], coast), IsEmpty());
}

}  // namespace
}  // namespace emscape::emfield
