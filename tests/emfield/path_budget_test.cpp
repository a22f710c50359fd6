// The budget of a path against the field's voxels and against closed forms.
#include "emscape/emfield/link/path_budget.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "emfield/columns/station.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/random_profile.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;
using ::testing::HasSubstr;

constexpr GeodeticPosition kSite{44.43, -71.47, 700};
constexpr PropagationModel kModels[] = {PropagationModel::free_space,  PropagationModel::horizon,
                                        PropagationModel::diffraction, PropagationModel::two_ray,
                                        PropagationModel::itm,         PropagationModel::p528,
                                        PropagationModel::p1812,       PropagationModel::p452};

/// The field interpolates p528 in a table, and these models between heights.
bool isInterpolated(PropagationModel model) {
  return model == PropagationModel::p528 || model == PropagationModel::itm ||
         model == PropagationModel::p1812 || model == PropagationModel::p452;
}

std::shared_ptr<scenario::Scenario> whiteMountains(PropagationModel model) {
  auto scenario = emptyScenario(FrameKind::altitude, 44.4, -71.5, {40e3, 40e3, 4000}, {50, 50, 40});
  scenario::Emitter emitter = plainEmitter("site", 0);
  emitter.propagation.model = model;
  emitter.antenna = scenario::makeGaussian(20, 30, 20, -25);
  addEmitter(*scenario, kSite, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_agl_m = 15;
  scenario->terrain = scenario::TerrainSpec{};
  return scenario;
}

/// The centre of a voxel as a path's end.
PathEnd endAt(const volume::Grid& grid, int i, int j, int k) {
  const GeoFrame frame(grid.frame);
  const Vec3d center = grid.center_m(i, j, k);
  return {frame.toGeodetic(center), frame.heightMsl_m(center)};
}

struct Compared {
  int voxels = 0;
  int other_shadow = 0;  ///< exactly one of both in shadow
  std::vector<double> errors_db;

  double quantile(double part) {
    std::sort(errors_db.begin(), errors_db.end());
    return errors_db[static_cast<std::size_t>(part * static_cast<double>(errors_db.size() - 1))];
  }
};

/// Budgets at random voxels above the ground against the field's values.
Compared compareWithField(const std::shared_ptr<scenario::Scenario>& scenario,
                          const scenario::TerrainPtr& terrain, int count) {
  scenario->output.floor = -300;
  const auto volume = solve(scenario, terrain);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  std::mt19937 random(11);
  Compared compared;
  while (compared.voxels < count) {
    const Dims& dims = volume->grid.dims;
    const int i = int(random() % unsigned(dims.x)), j = int(random() % unsigned(dims.y)),
              k = int(random() % unsigned(dims.z));
    const PathEnd end = endAt(volume->grid, i, j, k);
    if (terrain &&
        !(end.height_msl_m > terrain->heightMsl_m(end.position.latitude_deg, end.position.longitude_deg)))
      continue;
    ++compared.voxels;
    const PathBudget budget =
        pathBudget(snapshot, 0, end, scenario->emitters[0].propagation.model, terrain.get());
    const double value = budget.find("power_density_dbwm2")->value;
    const double voxel = static_cast<double>(valueAt(*volume, i, j, k));
    if (std::isinf(value) || voxel <= scenario->output.floor) {
      compared.other_shadow += std::isinf(value) != (voxel <= scenario->output.floor);
    } else {
      compared.errors_db.push_back(std::abs(value - voxel));
    }
  }
  return compared;
}

TEST(PathBudget, EqualsFieldInFreeSpace) {
  const auto scenario = whiteMountains(PropagationModel::free_space);
  scenario->terrain.reset();
  Compared compared = compareWithField(scenario, nullptr, 500);
  EXPECT_EQ(compared.other_shadow, 0);
  EXPECT_LT(compared.quantile(1), 2e-3);
}

TEST(PathBudget, SLOW_EqualsFieldOfEveryModelOverSmoothEarth) {
  for (const PropagationModel model : kModels) {
    SCOPED_TRACE(toString(model));
    const auto scenario = whiteMountains(model);
    scenario->terrain.reset();
    scenario->atmosphere.rain_mm_h = 10;
    scenario->atmosphere.gases = propagation::GasLosses::always;
    Compared compared = compareWithField(scenario, nullptr, 200);
    EXPECT_EQ(compared.other_shadow, 0);
    const bool is_table = isInterpolated(model);
    EXPECT_LT(compared.quantile(0.95), is_table ? 0.1 : 0.02);
    EXPECT_LT(compared.quantile(1), is_table ? 0.5 : 0.02);
  }
}

TEST(PathBudget, SLOW_EqualsFieldInExponentialAtmosphere) {
  for (const PropagationModel model : {PropagationModel::free_space, PropagationModel::horizon,
                                       PropagationModel::diffraction, PropagationModel::two_ray}) {
    SCOPED_TRACE(toString(model));
    const auto scenario = whiteMountains(model);
    scenario->terrain.reset();
    scenario->region.size_m = {500e3, 500e3, 25e3};
    scenario->region.dims = {40, 40, 25};
    scenario->atmosphere.refraction = propagation::RefractionProfile::exponential;
    Compared compared = compareWithField(scenario, nullptr, 200);
    EXPECT_EQ(compared.other_shadow, 0);
    EXPECT_LT(compared.quantile(1), 0.02);
  }
}

TEST(PathBudget, TheWarningOfGreatHeightsEndsWithAnExponentialAtmosphere) {
  const auto scenario = whiteMountains(PropagationModel::horizon);
  scenario->terrain.reset();
  const PathEnd end{{44.6, -69, 20e3}, 20e3};
  const auto warnings = [&] {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
    return pathBudget(snapshot, 0, end, PropagationModel::horizon, nullptr).warnings;
  };
  EXPECT_THAT(warnings(), ::testing::Contains(HasSubstr("'atmosphere: {refraction: exponential}' does")));
  scenario->atmosphere.refraction = propagation::RefractionProfile::exponential;
  EXPECT_THAT(warnings(), ::testing::IsEmpty());
}

TEST(PathBudget, SLOW_EqualsFieldOfEveryModelOverRealTerrain) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  for (const PropagationModel model : kModels) {
    SCOPED_TRACE(toString(model));
    Compared compared = compareWithField(whiteMountains(model), terrain, 200);
    const bool is_table = isInterpolated(model);
    EXPECT_EQ(compared.other_shadow, 0);
    EXPECT_LT(compared.quantile(0.9), is_table ? 0.1 : 0.02);
    EXPECT_LT(compared.quantile(0.97), is_table ? 1 : 0.02);
  }
}

TEST(PathBudget, PartsAddUpToTheSums) {
  auto scenario = whiteMountains(PropagationModel::diffraction);
  scenario->terrain.reset();
  scenario->receivers.emplace_back();
  scenario->receivers.front().gain_dbi = 3;
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const PathEnd end{{44.6, -71.2, 500}, 500};
  for (const PropagationModel model : kModels) {
    const PathBudget budget = pathBudget(snapshot, 0, end, model, nullptr);
    const auto value = [&](const char* key) { return budget.find(key)->value; };
    const double reflected_db = model == PropagationModel::two_ray ? value("reflected_ray_db") : 0;
    EXPECT_NEAR(value("eirp_dbw"),
                value("transmitter_power_dbw") + value("transmit_losses_db") + value("antenna_gain_dbi") +
                    value("antenna_pattern_db"),
                1e-9);
    EXPECT_NEAR(value("power_density_dbwm2"),
                value("eirp_dbw") + value("spreading_dbm2") - budget.excess.loss_db + reflected_db, 1e-9);
    EXPECT_NEAR(value("field_strength_dbuvm"), value("power_density_dbwm2") + 145.76, 0.01);
    EXPECT_NEAR(value("received_power_dbm"),
                30 + value("power_density_dbwm2") + value("isotropic_area_dbm2") +
                    value("receiver_antenna_db") + value("polarization_db") + value("in_band_db"),
                1e-9);
    EXPECT_NEAR(value("received_power_dbm"),
                30 + value("eirp_dbw") + 3 - value("transmission_loss_db") + reflected_db, 1e-6);
  }
}

/// A wall of 100 m across flat ground, half way of 20 km; both ends at 50 m.
PathProfile overAWall(double wall_m) {
  PathProfile profile;
  profile.effective_earth_radius_m = makeStation({44, -71, 50}, 50, 1e6).effective_earth_radius_m;  // flat
  profile.begin.height_msl_m = profile.end.height_msl_m = 50;
  profile.range_m = 20e3;
  for (int i = 0; i <= 200; ++i) {
    profile.ranges_m.push_back(100.0 * i);
    profile.ground_msl_m.push_back(i == 100 ? static_cast<float>(wall_m) : 0.0f);
    profile.ray_msl_m.push_back(50);
  }
  return profile;
}

TEST(PathObstacles, WallIsDominantObstacle) {
  const std::vector<PathObstacle> obstacles = pathObstacles(overAWall(150), 0.3);
  ASSERT_EQ(obstacles.size(), 1u);
  const PathObstacle& wall = obstacles.front();
  EXPECT_EQ(wall.range_m, 10e3);
  EXPECT_EQ(wall.clearance_m, -100);
  EXPECT_NEAR(wall.fresnel_radius_m, std::sqrt(0.3 * 5e3), 1e-9);
  EXPECT_NEAR(wall.nu, std::sqrt(2.0) * 100 / std::sqrt(0.3 * 5e3), 1e-9);
  EXPECT_NEAR(wall.knife_edge_db, 6.9 + 20 * std::log10(2 * wall.nu), 0.5);
  EXPECT_TRUE(wall.decides);
  EXPECT_FALSE(wall.is_earth_bulge);
}

TEST(PathObstacles, FlatGroundNamesNearestPoint) {
  const std::vector<PathObstacle> obstacles = pathObstacles(overAWall(0), 0.3);
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_GT(obstacles.front().clearance_m, 0);
  EXPECT_TRUE(obstacles.front().decides);
}

TEST(PathObstacles, CrestsWithAValleyBetweenAreSeparate) {
  PathProfile profile = overAWall(150);
  profile.ground_msl_m[40] = 120;
  profile.ground_msl_m[101] = 145;  // the same crest
  const std::vector<PathObstacle> obstacles = pathObstacles(profile, 0.3);
  ASSERT_EQ(obstacles.size(), 2u);
  EXPECT_EQ(obstacles[0].range_m, 4e3);
  EXPECT_FALSE(obstacles[0].decides);
  EXPECT_TRUE(obstacles[1].decides);
}

TEST(PathObstacles, AreTheEarthsBulgeOnlyWhereTheReliefOfTheTerrainIsLower) {
  PathProfile profile = overAWall(0);
  profile.effective_earth_radius_m = 8.5e6;  // a bulge of 5.88 m in the middle
  const auto isBulge = [&](double ends_m, double hill_m, double mast_m) {
    for (int i = 0; i < profile.count(); ++i) {
      profile.ground_msl_m[i] = static_cast<float>(i == 100 ? ends_m + hill_m : ends_m);
      profile.ray_msl_m[i] = ends_m + mast_m - profile.bulge_m(i);
    }
    const std::vector<PathObstacle> obstacles = pathObstacles(profile, 0.3);
    EXPECT_EQ(obstacles.size(), 1u);
    EXPECT_EQ(obstacles.at(0).post, 100);
    EXPECT_LT(obstacles.at(0).clearance_m, 0);
    return obstacles.at(0).is_earth_bulge;
  };
  EXPECT_TRUE(isBulge(0, 0, 5)) << "the sea";
  EXPECT_TRUE(isBulge(500, 0, 5)) << "a plateau";
  EXPECT_TRUE(isBulge(0, 4, 5)) << "low ground";
  EXPECT_FALSE(isBulge(0, 7, 8)) << "a hill, above the ray by the bulge alone";
  EXPECT_FALSE(isBulge(0, 5.6, 6)) << "0.4 m below the ray, and the earth alone in sight";
  EXPECT_FALSE(isBulge(0, 100, 3)) << "far above the ray without the bulge";
}

TEST(PathObstacles, OfALongPathAreTheEarthWhereAHillAddsLittle) {
  const auto isBulge = [](double length_m, double hill_m) {
    PathProfile profile;
    profile.effective_earth_radius_m = 8.5e6;
    profile.range_m = length_m;
    constexpr double kMast_m = 30, kHill_m = 20e3;
    for (int i = 0; i <= 300; ++i) {
      profile.ranges_m.push_back(length_m / 300 * i);
      const bool is_hill = std::abs(profile.ranges_m[i] - kHill_m) < 500;
      profile.ground_msl_m.push_back(is_hill ? static_cast<float>(hill_m) : 0.0f);
      profile.ray_msl_m.push_back(kMast_m - profile.bulge_m(i));
    }
    const std::vector<PathObstacle> obstacles = pathObstacles(profile, 0.1);
    const auto decides = std::find_if(obstacles.begin(), obstacles.end(),
                                      [](const PathObstacle& obstacle) { return obstacle.decides; });
    return decides->is_earth_bulge;
  };
  EXPECT_TRUE(isBulge(150e3, 0));
  EXPECT_TRUE(isBulge(150e3, 200)) << "a hill above the straight ray";
  EXPECT_FALSE(isBulge(40e3, 200)) << "the same hill, with the ends in sight over the sea";
}

TEST(PathBudget, VerdictSaysThatAModelOnASmoothSurfaceIgnoresTheTerrain) {
  const auto scenario = whiteMountains(PropagationModel::two_ray);
  const auto [latitude_deg, longitude_deg] =
      std::pair(scenario->platforms[0].track[0].position.latitude_deg,
                scenario->platforms[0].track[0].position.longitude_deg);
  constexpr double kSide_deg = 0.5;
  const MadeTerrain terrain(latitude_deg, longitude_deg, kSide_deg, [](double, double north_deg) {
    return std::abs(north_deg - kSide_deg / 2 - 0.05) < 0.003 ? 300.0 : 0.0;  // a wall 5.6 km to the north
  });
  const PathEnd behind{
      {latitude_deg + 0.1, longitude_deg, 20 + geoidUndulation_m(latitude_deg, longitude_deg)}, 20};
  const auto verdict = [&](PropagationModel model) {
    return pathBudget(scenario::snapshotAt(scenario, &terrain, 0), 0, behind, model, &terrain).verdict;
  };
  EXPECT_THAT(verdict(PropagationModel::diffraction), ::testing::StartsWith("Blocked: the terrain at 5."));
  EXPECT_THAT(verdict(PropagationModel::two_ray),
              ::testing::StartsWith("Not in sight, which 'two_ray' ignores: the terrain at 5."));
}

TEST(PathBudget, VerdictNamesTheReason) {
  auto scenario = whiteMountains(PropagationModel::diffraction);
  scenario->terrain.reset();
  scenario->emitters[0].antenna = scenario::makeIsotropic();
  scenario->emitters[0].active_s = {{0, 5}};
  const auto verdict = [&](const GeodeticPosition& at, double height_msl_m, double t_s) {
    return pathBudget(scenario::snapshotAt(scenario, nullptr, t_s), 0, {at, height_msl_m},
                      scenario->emitters[0].propagation.model, nullptr)
        .verdict;
  };
  EXPECT_THAT(verdict({44.5, -71.4, 3000}, 3000, 0), ::testing::StartsWith("Clear: "));
  EXPECT_THAT(verdict({45.4, -71.4, 10}, 10, 0),
              ::testing::AllOf(::testing::StartsWith("Blocked: the earth's bulge at "),
                               HasSubstr("above the ray"), HasSubstr("the path costs ")));
  EXPECT_EQ(verdict({44.5, -71.4, 3000}, 3000, 7), "Silent: 'site' does not radiate at t = 7 s.");
  scenario->emitters[0].propagation.model = PropagationModel::horizon;
  EXPECT_THAT(verdict({45.4, -71.4, 10}, 10, 0), HasSubstr("the model gives no field behind it"));
  scenario->emitters[0].antenna = scenario::makeGaussian(30, 3, 3, -40);
  EXPECT_THAT(verdict({44.3, -71.47, 3000}, 3000, 0), HasSubstr("but the antenna points "));
  EXPECT_THAT(verdict({43.2, -71.47, 10}, 10, 0),
              HasSubstr("the model gives no field behind it, and the antenna points "));
}

TEST(PathBudget, VerdictOfRadarOnTargetOmitsScanDirection) {
  auto scenario = whiteMountains(PropagationModel::free_space);
  scenario->terrain.reset();
  scenario::Emitter& radar = scenario->emitters[0];
  radar.kind = scenario::EmitterKind::radar;
  radar.antenna = scenario::makeGaussian(30, 3, 3, -40);
  radar.scan.kind = scenario::ScanKind::sector;
  radar.scan.azimuth_deg = 180;
  radar.scan.rate_deg_s = 10;
  radar.scan.width_deg = 60;
  const GeodeticPosition south{44.1, -71.4, 400}, north{44.6, -71.4, 400};
  const auto budget = [&](const GeodeticPosition& at, scenario::RadarAim look) {
    scenario->output.radar_look = look;
    return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, {at, 400}, PropagationModel::free_space,
                      nullptr);
  };
  const PathBudget of_scan = budget(south, scenario::RadarAim::scan);
  EXPECT_FALSE(of_scan.look_pattern_db);
  EXPECT_THAT(of_scan.verdict, HasSubstr("but the antenna points "));
  const PathBudget at_target = budget(south, scenario::RadarAim::target);
  ASSERT_TRUE(at_target.look_pattern_db);
  EXPECT_GT(*at_target.look_pattern_db, -3);
  EXPECT_THAT(at_target.verdict, ::testing::Not(HasSubstr("but the ")));
  EXPECT_THAT(at_target.verdict, HasSubstr("a target there is detected with probability"));
  scenario->output.interval.kind = scenario::IntervalKind::max_hold;
  const PathBudget in_interval = budget(south, scenario::RadarAim::scan);
  ASSERT_TRUE(in_interval.look_pattern_db) << "the scan's best moment";
  EXPECT_EQ(*in_interval.look_pattern_db, *at_target.look_pattern_db);
  EXPECT_EQ(in_interval.find("snr_db")->value, at_target.find("snr_db")->value);
  EXPECT_THAT(in_interval.verdict, ::testing::Not(HasSubstr("but the ")));
  scenario->output.interval.kind = scenario::IntervalKind::instant;
  // Outside the sector the beam stays at the sector's end.
  const PathBudget beside = budget(north, scenario::RadarAim::target);
  EXPECT_NEAR(*beside.look_pattern_db, -40, 0.1);
  EXPECT_THAT(beside.verdict, HasSubstr("but the scan does not reach there, which costs 40.0 dB"));
}

TEST(PathBudget, VerdictNamesJamming) {
  auto scenario = whiteMountains(PropagationModel::free_space);
  scenario->terrain.reset();
  scenario->emitters[0].kind = scenario::EmitterKind::radar;
  const PathEnd point{{44.1, -71.4, 400}, 400};
  const auto budget = [&] {
    return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, point, PropagationModel::free_space,
                      nullptr);
  };
  const auto verdict = [&] { return budget().verdict; };
  EXPECT_THAT(verdict(), ::testing::Not(HasSubstr("J/S")));
  scenario::Platform elsewhere = scenario->platforms[0];
  elsewhere.track[0].position.latitude_deg += 0.3;
  elsewhere.track[0].position.height_msl_m = 3000;
  elsewhere.track[0].position.height_agl_m.reset();
  scenario->platforms.push_back(elsewhere);
  scenario::Emitter jammer = scenario->emitters[0];
  jammer.name = "jammer";
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.platform = static_cast<int>(scenario->platforms.size()) - 1;
  scenario->emitters.push_back(jammer);
  EXPECT_THAT(verdict(), ::testing::ContainsRegex("\\(SNR -?[0-9.]+ dB, J/S 100.0 dB by 'jammer'\\)\\."))
      << "a fixed beam, which turns to no target";
  scenario->emitters[0].scan.kind = scenario::ScanKind::rotate;
  scenario->output.radar_look = scenario::RadarAim::scan;
  EXPECT_THAT(verdict(),
              ::testing::ContainsRegex("\\(SNR -?[0-9.]+ dB where the scan has the beam, J/S -?[0-9.]+ dB by "
                                       "'jammer' with the beam on the target\\)\\."));
  scenario->emitters[0].scan.kind = scenario::ScanKind::fixed;
  scenario->output.radar_look = scenario::RadarAim::target;
  const auto scale = [&](std::size_t emitter, const char* key, double wanted_db) {
    const double now_db = budget().find(key)->value;
    scenario->emitters[emitter].power_w *= dbToRatio(wanted_db - now_db);
  };
  scale(0, "snr_db", 35);
  scale(1, "jammer_to_signal_db", 20);
  EXPECT_THAT(verdict(),
              ::testing::ContainsRegex(
                  "^Jammed by 'jammer': J/S 20.0 dB, without which a target there is detected with "
                  "probability [0-9.]+; [a-z].* is detected with probability 0.0"))
      << "it decides";
  scenario->emitters.push_back(scenario->emitters[1]);
  scenario->emitters[2].name = "stronger";
  scenario->emitters[2].power_w *= 3;
  EXPECT_THAT(verdict(), ::testing::StartsWith("Jammed by 'stronger' and 1 more: "));
  scenario->emitters.pop_back();
  scale(1, "jammer_to_signal_db", -18);
  EXPECT_THAT(verdict(),
              ::testing::AllOf(HasSubstr("J/S -18.0 dB by 'jammer'"), ::testing::Not(HasSubstr("Jammed"))))
      << "detected in spite of jamming";
  scenario->emitters[1].power_w = 1e-12;
  EXPECT_THAT(verdict(), ::testing::Not(HasSubstr("J/S"))) << "too weak to matter";
}

TEST(PathBudget, RefusesPathsOverMissingTerrainAndOfNoLength) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const scenario::Snapshot snapshot =
      scenario::snapshotAt(whiteMountains(PropagationModel::diffraction), terrain.get(), 0);
  const auto refusal = [&](const PathEnd& end) {
    return test::errorOf([&] { pathBudget(snapshot, 0, end, PropagationModel::diffraction, terrain.get()); });
  };
  EXPECT_THAT(refusal({{46, -71.47, 2000}, 2000}), HasSubstr("terrain is missing on the path, "));
  EXPECT_THAT(refusal({{kSite.latitude_deg, kSite.longitude_deg, 2000}, 2000}),
              HasSubstr("km long over the ground"));
}

TEST(PathBudget, WarnsOfEndsBelowTheLowestHeightOfTheModel) {
  for (const auto& [model, lowest_m] : {std::pair{PropagationModel::diffraction, 1.0},
                                        {PropagationModel::itm, 0.5},
                                        {PropagationModel::p1812, 1.0},
                                        {PropagationModel::p452, 1.0},
                                        {PropagationModel::two_ray, 1.0},
                                        {PropagationModel::p528, 1.5}}) {
    auto scenario = emptyScenario(FrameKind::altitude, 44.4, -71.5, {40e3, 40e3, 4000}, {50, 50, 40});
    scenario::Emitter emitter = plainEmitter("site", 0);
    emitter.propagation.model = model;
    addEmitter(*scenario, {44.4, -71.5, geoidUndulation_m(44.4, -71.5) + 20}, emitter);
    const auto warningsAt = [&](double height_m) {
      const PathEnd end{{44.5, -71.5, geoidUndulation_m(44.5, -71.5) + height_m}, height_m};
      std::string all;
      for (const std::string& warning :
           pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, end, model, nullptr).warnings)
        all += warning + "\n";
      return all;
    };
    EXPECT_THAT(warningsAt(lowest_m - 0.2), HasSubstr("the point is ")) << toString(model);
    EXPECT_THAT(warningsAt(lowest_m - 0.2), HasSubstr(fmt::format("takes it as {:g} m high", lowest_m)));
    EXPECT_THAT(warningsAt(lowest_m + 0.2), ::testing::Not(HasSubstr("takes it as"))) << toString(model);
  }
}

}  // namespace
}  // namespace emscape::emfield
