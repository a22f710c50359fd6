// Maps of clutter of land, sea and rain, and detection before it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "emfield/channels/radar_clutter.h"
#include "emfield/clutter/mti.h"
#include "emfield/geometry/clutter_map.h"
#include "emscape/emfield/link/link.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kLatitude_deg = 44.3, kLongitude_deg = -71.4;

scenario::Emitter cluttered(scenario::Emitter radar) {
  radar.waveform = scenario::Waveform{1000, 1e-6, {}};
  radar.clutter.emplace();
  radar.clutter->range_cell_m = 150;
  return radar;
}

struct FilledMap {
  ClutterGrid grid;
  std::vector<ClutterCell> cells;

  const ClutterCell& at(int azimuth, double range_m) const {
    return cells[static_cast<std::size_t>(azimuth) * grid.ranges +
                 static_cast<std::size_t>(range_m / double(grid.step_m))];
  }
};

FilledMap mapOf(const scenario::Scenario& scenario, const scenario::Emitter& radar, double height_msl_m,
                const scenario::Terrain* terrain) {
  const Station station = makeStation({kLatitude_deg, kLongitude_deg, height_msl_m}, height_msl_m, 4.0 / 3);
  std::optional<ClutterMapTask> task = clutterMapTask(scenario, radar, station);
  const std::vector<double> ranges_m = clutterPostRanges(task->grid, postSpacing_m(terrain));
  task->ground = groundPosts(terrain, ranges_m);
  FilledMap map{task->grid, std::vector<ClutterCell>(task->grid.cells())};
  fillClutterMapCpu(*task, map.cells.data());
  return map;
}

TEST(ClutterMap, SmoothSeaEqualsClosedForm) {
  const auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {80e3, 80e3, 1000}, {8, 8, 2});
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.clutter->sea_state = 4;
  constexpr double kHeight_m = 100;
  const FilledMap map = mapOf(*scenario, radar, kHeight_m, nullptr);
  const double radius_m =
      makeStation({kLatitude_deg, kLongitude_deg, 0}, 0, 4.0 / 3).effective_earth_radius_m;
  const double horizon_m = std::sqrt(2 * radius_m * kHeight_m);
  for (double range_m = 2625; range_m < 0.95 * horizon_m; range_m += 1500) {  // middles of cells
    const double sine = kHeight_m / range_m - range_m / (2 * radius_m);
    const double sigma0 = dbToRatio(seaReflectivityDb(seaConstants(true), 3, 4, sine));
    const ClutterCell& cell = map.at(17, range_m);
    // a ring's part of one radian has the area R dR
    EXPECT_NEAR(ratioToDb(double(cell.echo) / (sigma0 * 150 / std::pow(range_m, 3))), 0, 0.02) << range_m;
    EXPECT_NEAR(double(cell.sine / cell.echo), -kHeight_m / range_m - range_m / (2 * radius_m), 2e-4);
    EXPECT_EQ(cell.echo, map.at(60, range_m).echo) << "the same all round";
  }
  EXPECT_EQ(map.at(17, horizon_m + 1000).echo, 0) << "beyond the horizon";
}

/// Ground of one height per distance east of a meridian.
class Ridges : public MadeTerrain {
 public:
  explicit Ridges(const std::function<double(double east_m)>& height_m)
      : MadeTerrain(kLatitude_deg, kLongitude_deg, 1.0, [&](double east_deg, double) {
          return height_m(degToRad(east_deg - 0.5) * 6378e3 * std::cos(degToRad(kLatitude_deg)));
        }) {}
};

TEST(ClutterMap, IsZeroBehindRidgeAndLargerOnItsSlope) {
  const auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {40e3, 40e3, 1000}, {8, 8, 2});
  const Ridges terrain(
      [](double east_m) { return 50 + 300 * std::exp(-std::pow((east_m - 9000) / 600, 2)); });
  const Ridges flat([](double) { return 50.0; });
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.clutter->land_gamma_db = -15;
  const FilledMap map = mapOf(*scenario, radar, 80, &terrain), plain = mapOf(*scenario, radar, 80, &flat);
  const int east = map.grid.azimuths / 4, west = 3 * east;
  EXPECT_GT(map.at(east, 8500).echo, 10 * plain.at(east, 8500).echo);
  for (double range_m = 9500; range_m < 18e3; range_m += 150) {
    EXPECT_EQ(map.at(east, range_m).echo, 0) << range_m;
    EXPECT_GT(plain.at(east, range_m).echo, 0) << range_m;
    EXPECT_NEAR(map.at(west, range_m).echo / plain.at(west, range_m).echo, 1, 1e-3);
  }
  // constant gamma over flat ground: gamma h / R^4 per metre of range and radian
  const double depth_m = 30 + 6000.0 * 6000 / (2 * 8.5e6), sine = 30 / 6075.0 - 6075 / (2 * 8.5e6);
  EXPECT_NEAR(double(plain.at(east, 6075).echo) / (dbToRatio(-15) * sine * 150 / std::pow(6075, 3)), 1, 0.02);
  EXPECT_NEAR(double(plain.at(east, 6075).sine / plain.at(east, 6075).echo), -depth_m / 6075, 2e-4);
}

TEST(ClutterMap, LowGroundIsSeaOnlyWhereThereIsSea) {
  const auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {40e3, 40e3, 1000}, {8, 8, 2});
  const Ridges coast([](double east_m) { return east_m > 5000 ? 0.0 : 20.0; });
  scenario::Emitter land = cluttered(trackingRadar()), both = land, sea = land;
  land.clutter->land_gamma_db = both.clutter->land_gamma_db = -15;
  both.clutter->sea_state = sea.clutter->sea_state = 2;
  const FilledMap of_land = mapOf(*scenario, land, 200, &coast),
                  of_both = mapOf(*scenario, both, 200, &coast), of_sea = mapOf(*scenario, sea, 200, &coast);
  const int east = of_land.grid.azimuths / 4;
  EXPECT_EQ(of_both.at(east, 3000).echo, of_land.at(east, 3000).echo);
  EXPECT_EQ(of_both.at(east, 8000).echo, of_sea.at(east, 8000).echo);
  EXPECT_EQ(of_sea.at(east, 3000).echo, 0);
  EXPECT_GT(of_land.at(east, 8000).echo, 10 * of_sea.at(east, 8000).echo);
}

// A high PRF over a large region, whose map has steps of 0.4 km and more.
TEST(ClutterOfAPath, OfManyTripsDoesNotDependOnTheMapsSteps) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 3, -40);
  radar.clutter->sea_state = 5;
  radar.waveform = scenario::Waveform{kSpeedOfLight / 2 / 600, 3e-7, {}};
  radar.waveform->limits_detection = false;
  radar.clutter->range_cell_m = 45;
  const auto clutterIn = [&](double size_m) {
    const auto scenario =
        emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {size_m, size_m, 12000}, {8, 8, 2});
    addEmitter(*scenario, {kLatitude_deg, kLongitude_deg, 8000}, radar);
    scenario->output.quantities = {"sclnr_db"};
    const PathEnd end{{kLatitude_deg, kLongitude_deg + 0.8, 6000}, 6000};
    const PathBudget budget =
        pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, end, radar.propagation.model, nullptr);
    return budget.find("surface_clutter_to_noise_db")->value;
  };
  const double wanted_db = clutterIn(600e3);  // beyond the horizon
  EXPECT_GT(wanted_db, -20);
  EXPECT_NEAR(clutterIn(1000e3), wanted_db, 1);
  EXPECT_NEAR(clutterIn(2000e3), wanted_db, 1);
}

// ---- the field
// ---------------------------------------------------------------------------------------------

class Clutter : public test::OnBackends {
 protected:
  std::shared_ptr<const volume::DenseVolume> field(const std::shared_ptr<scenario::Scenario>& scenario,
                                                   const char* quantity,
                                                   const scenario::TerrainPtr& terrain = nullptr) const {
    scenario->output.quantities = {quantity};
    FieldOptions options;
    options.backend = GetParam();
    return solve(scenario, terrain, options);
  }
};

/// A tracking radar above the middle of a line of voxels.
std::shared_ptr<scenario::Scenario> lineWith(const scenario::Emitter& radar) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario->output.radar_look = scenario::RadarAim::target;
  addEmitter(*scenario, middleOf(*scenario), radar);
  return scenario;
}

/// Clutter over noise from the echo with and without it.
double clutterToNoise(double snr_db, double sclnr_db) {
  return dbToRatio(snr_db - sclnr_db) - 1;
}

TEST_P(Clutter, SeaEqualsClosedFormOfItsPatch) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 40, -80);
  radar.clutter->sea_state = 5;
  const auto scenario = lineWith(radar);
  const auto snr = field(scenario, "snr_db"), sclnr = field(scenario, "sclnr_db");
  const scenario::EmitterState state = scenario::snapshotAt(scenario, nullptr, 0).emitters[0];
  const double radius_m = makeStation(state.position, state.height_msl_m, 1).effective_earth_radius_m;
  const double azimuth_rad = degToRad(3.0) * std::sqrt(kPi / (8 * std::log(2.0)));
  for (double range_m = 5e3; range_m < 40e3; range_m += 5e3) {
    const double sine = state.height_msl_m / range_m - range_m / (2 * radius_m);
    const double down_deg = radToDeg(std::asin(state.height_msl_m / range_m + range_m / (2 * radius_m)));
    const double pattern_db = -24 * std::pow(down_deg / 40, 2);  // there and back
    const double rcs_m2 =
        dbToRatio(seaReflectivityDb(seaConstants(true), 3, 5, sine)) * range_m * azimuth_rad * 150;
    const double expected_db = radarSnrDb(linkTowardsTarget(radar), rcs_m2, range_m) + pattern_db;
    EXPECT_NEAR(
        ratioToDb(clutterToNoise(double(valueEast(*snr, range_m)), double(valueEast(*sclnr, range_m)))),
        expected_db, 0.1)
        << range_m;
  }
}

TEST_P(Clutter, OfALongRangeCellIsTheSumOfItsParts) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 5, 5, -40);
  radar.clutter->sea_state = 5;
  const auto clutterAt = [&](double cell_m) {
    radar.clutter->range_cell_m = cell_m;
    const auto scenario = lineWith(radar);
    const auto snr = field(scenario, "snr_db"), sclnr = field(scenario, "sclnr_db");
    return [snr, sclnr](double range_m) {
      return clutterToNoise(double(valueEast(*snr, range_m)), double(valueEast(*sclnr, range_m)));
    };
  };
  const auto whole = clutterAt(3 * kSpacing_m), part = clutterAt(kSpacing_m);
  // The beam ends within the cells' span of elevations; at 5 km they span more than its width.
  for (const double range_m : {5e3, 6e3, 7e3, 9e3}) {
    const double sum = part(range_m - kSpacing_m) + part(range_m) + part(range_m + kSpacing_m);
    EXPECT_NEAR(ratioToDb(whole(range_m) / sum), 0, range_m > 5e3 ? 0.5 : 3) << range_m;
  }
}

TEST_P(Clutter, OfLaterTripsIsSeenByTheBeamTowardsItsOwnSurface) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 3, -40);
  radar.clutter->sea_state = 5;
  const auto clutterAt = [&](double prf_hz) {
    radar.waveform->prf_hz = prf_hz;
    const auto scenario = lineWith(radar);
    const auto snr = field(scenario, "snr_db"), sclnr = field(scenario, "sclnr_db");
    return [snr, sclnr](double range_m) {
      return clutterToNoise(double(valueEast(*snr, range_m)), double(valueEast(*sclnr, range_m)));
    };
  };
  const auto single = clutterAt(1000), folded = clutterAt(kSpeedOfLight / 2 / 12e3);
  for (const double range_m : {2e3, 3e3, 8e3, 11e3}) {
    double sum = 0;
    for (double trip_m = range_m; trip_m < 40e3; trip_m += 12e3) sum += single(trip_m);
    for (const double same_m : {range_m, range_m + 12e3})
      EXPECT_NEAR(ratioToDb(folded(same_m) / sum), 0, 0.05) << same_m;
  }
  EXPECT_GT(folded(2e3), 1000 * single(2e3)) << "the beam passes above the nearest surface";
}

TEST_P(Clutter, IsEclipsedAsTheEchoThatItArrivesWith) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.waveform->pulse_width_s = 10e-6;  // nothing is heard whole before 1.5 km
  radar.clutter->land_gamma_db = 20;
  const auto probabilities = [&](bool limits) {
    radar.waveform->limits_detection = limits;
    return field(lineWith(radar), "detection_probability");
  };
  const auto eclipsed = probabilities(true), whole = probabilities(false);
  const double in_clutter = double(valueEast(*whole, 1000));
  EXPECT_GT(in_clutter, 0.01);
  EXPECT_LT(in_clutter, 0.99);
  EXPECT_NEAR(double(valueEast(*eclipsed, 1000)), in_clutter, 1e-3) << "the ratio stays";
}

TEST_P(Clutter, RainEqualsClosedFormOfItsVolume) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 2, 2, -80);
  radar.clutter->rain = true;
  const auto scenario = lineWith(radar);
  scenario->atmosphere.rain_mm_h = 10;
  scenario->atmosphere.rain_height_m = 4000;
  scenario->atmosphere.gases = propagation::GasLosses::never;
  const auto snr = field(scenario, "snr_db"), sclnr = field(scenario, "sclnr_db");
  const double eta = rainReflectivity_m2_m3(10, 3e9);
  const double loss_db_per_m = airLossAtSea_db_per_m(*scenario, scenario->emitters[0]);
  EXPECT_GT(loss_db_per_m, 0);
  for (double range_m = 2e3; range_m <= 14e3; range_m += 4e3) {
    const double volume_m3 = kPi * std::pow(degToRad(2.0), 2) / (8 * std::log(2.0)) * range_m * range_m * 150;
    const double expected_db =
        radarSnrDb(linkTowardsTarget(radar), eta * volume_m3, range_m) - 2 * loss_db_per_m * range_m;
    EXPECT_NEAR(
        ratioToDb(clutterToNoise(double(valueEast(*snr, range_m)), double(valueEast(*sclnr, range_m)))),
        expected_db, 0.05)
        << range_m;
  }
  scenario->emitters[0].clutter->rain = false;
  EXPECT_EQ(field(scenario, "sclnr_db")->values, field(scenario, "snr_db")->values) << "none behind";
}

TEST_P(Clutter, IsMappedWhenAQuantityNeedsItAndKept) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.clutter->sea_state = 5;
  const auto of = [&](const char* quantity, int sea_state) {
    auto scenario = lineWith(radar);
    scenario->emitters[0].clutter->sea_state = sea_state;
    scenario->output.quantities = {quantity};
    return scenario;
  };
  FieldOptions options;
  options.backend = GetParam();
  FieldSolver solver(of("snr_db", 5), nullptr, options);
  const auto update = [&](const std::shared_ptr<scenario::Scenario>& scenario) {
    const FieldChanged changed = solver.update(scenario::snapshotAt(scenario, nullptr, 0));
    EXPECT_EQ(solver.volumes().front().host()->values,
              field(scenario, scenario->output.quantities.front().c_str())->values);
    return changed.moved.size();
  };
  update(of("snr_db", 5));
  const std::size_t without = solver.memoryUse().total_bytes;
  EXPECT_EQ(update(of("sclnr_db", 5)), 1u);
  EXPECT_GT(solver.memoryUse().total_bytes, without) << "there was no map before";
  EXPECT_EQ(update(of("snr_db", 5)), 0u);
  EXPECT_EQ(update(of("sclnr_db", 5)), 0u) << "the map was kept";
  EXPECT_EQ(update(of("snr_db", 2)), 0u) << "what nothing needs";
  EXPECT_EQ(update(of("sclnr_db", 2)), 1u);
}

TEST(ClutterWarnings, NameThePartOfTheGroundAtSeaLevelThatIsTakenForLand) {
  const auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {40e3, 40e3, 1000}, {8, 8, 2});
  const auto coast = std::make_shared<Ridges>([](double east_m) { return east_m > 5000 ? 0.0 : 20.0; });
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.clutter->land_gamma_db = -15;
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario->output.quantities = {"sclnr_db"};
  const auto warnings = [&] {
    std::string all;
    for (const std::string& warning : FieldSolver(scenario, coast, {}).warnings()) all += warning + "\n";
    return all;
  };
  EXPECT_THAT(warnings(),
              ::testing::ContainsRegex("also the 3[78] % of it that are at or below mean sea level"));
  scenario->emitters[0].clutter->sea_state = 2;
  EXPECT_THAT(warnings(), ::testing::Not(::testing::HasSubstr("mean sea level; where")));
}

TEST(ClutterWarnings, NameSurfacesBeyondTheRegionWhoseEchoesArriveWithThoseInside) {
  const auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {40e3, 40e3, 1000}, {8, 8, 2});
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.clutter->sea_state = 3;
  radar.waveform->prf_hz = 1000;  // 150 km
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario->output.quantities = {"sclnr_db"};
  const auto warningsAt = [&](double height_msl_m) {
    scenario::SitePosition& site = scenario->platforms[0].track[0].position;
    site.height_ellipsoid_m.reset();
    site.height_msl_m = height_msl_m;
    const FieldSolver solver(scenario, nullptr, {});
    return solver.warnings().empty() ? std::string() : solver.warnings()[0];
  };
  EXPECT_EQ(warningsAt(500), "") << "a horizon of 92 km";
  EXPECT_THAT(
      warningsAt(8000),
      ::testing::HasSubstr("surfaces between 150 km and its horizon at 369 km are beyond the region"));
}

TEST_P(Clutter, EntersDetectionAsNoise) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 40, -80);
  radar.clutter->sea_state = 5;
  radar.clutter->mti.emplace();
  radar.clutter->mti->surface_spread_mps = 1;
  radar.clutter->target_radial_speed_mps = 20;
  const auto scenario = lineWith(radar);
  const auto sclnr = field(scenario, "sclnr_db"), detection = field(scenario, "detection_probability");
  const Detector detector = detectorOf(radar.receiver);
  for (double range_m = 3e3; range_m < 40e3; range_m += 3e3) {
    const double expected = detectionProbability(detector, detectionThreshold(detector),
                                                 dbToRatio(double(valueEast(*sclnr, range_m))));
    EXPECT_NEAR(valueEast(*detection, range_m), expected, 2e-4) << range_m;
  }
  scenario->emitters[0].clutter->target_radial_speed_mps =
      radar.waveform->firstBlindSpeed_mps(radar.frequency_hz);
  EXPECT_LT(valueEast(*field(scenario, "detection_probability"), 5e3), 1e-4) << "a blind speed";
}

TEST_P(Clutter, ThatStandsStillIsOneSampleForAllPulses) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 40, -80);
  radar.clutter->sea_state = 5;
  radar.power_w = 1e9;  // far above the noise
  radar.receiver.pulses = 16;
  constexpr double kRange_m = 6e3;
  radar.receiver.target_rcs_m2 = 1;
  const double of_unit_db = double(valueEast(*field(lineWith(radar), "sclnr_db"), kRange_m));
  for (const int swerling : {0, 1, 2}) {
    radar.receiver.swerling = swerling;
    for (const int samples : {1, 4, 16}) {
      Detector of_samples = detectorOf(radar.receiver);
      of_samples.pulses = samples;
      radar.clutter->independent_samples = samples;
      radar.receiver.target_rcs_m2 = dbToRatio(requiredSnrDb(of_samples, 0.5) - of_unit_db);
      EXPECT_NEAR(valueEast(*field(lineWith(radar), "detection_probability"), kRange_m), 0.5, 2e-3)
          << swerling << ' ' << samples;
    }
  }
}

TEST_P(Clutter, SLOW_VoxelEqualsItsPath) {
  const auto terrain = std::make_shared<MadeTerrain>(44.5, -71.5, 1);
  for (const bool looks_at_target : {true, false}) {
    auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {40e3, 40e3, 5000}, {40, 40, 12});
    scenario->terrain = scenario::TerrainSpec{};
    scenario::Emitter radar = cluttered(trackingRadar());
    radar.power_w = 2e5;
    radar.clutter->land_gamma_db = -10;
    radar.clutter->sea_state = 3;
    radar.clutter->rain = true;
    radar.clutter->mti.emplace();
    radar.clutter->mti->surface_spread_mps = 0.3;
    radar.clutter->mti->rain_spread_mps = 2;
    if (!looks_at_target) {
      radar.scan.kind = scenario::ScanKind::rotate;
      radar.scan.azimuth_deg = 30;
      radar.scan.rate_rpm = 6;
    }
    scenario->atmosphere.rain_mm_h = 2;
    scenario->output.radar_look = looks_at_target ? scenario::RadarAim::target : scenario::RadarAim::scan;
    addEmitter(*scenario, {44.45, -71.52, 0}, radar);
    scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario->platforms[0].track[0].position.height_agl_m = 20;
    const auto sclnr = field(scenario, "sclnr_db", terrain), snr = field(scenario, "snr_db", terrain),
               detection = field(scenario, "detection_probability", terrain);
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
    const GeoFrame frame(sclnr->grid.frame);
    int compared = 0, limited = 0;
    for (int i = 1; i < 40; i += 3) {
      for (int j = 2; j < 40; j += 3) {
        for (const int k : {3, 7, 11}) {
          const Vec3d center = sclnr->grid.center_m(i, j, k);
          const PathBudget budget =
              pathBudget(snapshot, 0, {frame.toGeodetic(center), frame.heightMsl_m(center)},
                         radar.propagation.model, terrain.get());
          const double of_path = budget.find("sclnr_db")->value;
          if (k < sclnr->first_valid_k[j * 40 + i] || of_path < -200) continue;
          ++compared;
          limited += valueAt(*snr, i, j, k) - valueAt(*sclnr, i, j, k) > 3 ? 1 : 0;
          EXPECT_NEAR(double(valueAt(*sclnr, i, j, k)), of_path, 0.02) << i << ' ' << j << ' ' << k;
          EXPECT_NEAR(double(valueAt(*detection, i, j, k)), budget.find("detection_probability")->value,
                      2e-3);
        }
      }
    }
    EXPECT_GT(compared, 200);
    EXPECT_GT(limited, 20);
  }
}

TEST_P(Clutter, AfterEditEqualsNewSolver) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 40, -80);
  radar.clutter->sea_state = 2;
  const auto scenario = lineWith(radar);
  scenario->output.quantities = {"sclnr_db"};
  FieldOptions options;
  options.backend = GetParam();
  SolvedField solver(scenario, nullptr, options);
  const auto before = solver.volumes().front().host();
  const auto edited = std::make_shared<scenario::Scenario>(*scenario);
  edited->emitters[0].clutter->sea_state = 6;
  solver.update(scenario::snapshotAt(edited, nullptr, 0));
  const auto after = solver.volumes().front().host();
  EXPECT_NE(after->values, before->values);
  EXPECT_EQ(after->values, field(edited, "sclnr_db")->values);
}

EMSCAPE_ON_BACKENDS(Clutter);

TEST(ClutterOfALink, UsesRadialSpeedOfTarget) {
  scenario::Emitter radar = cluttered(trackingRadar());
  radar.antenna = scenario::makeGaussian(kGain_dbi, 3, 40, -80);
  radar.clutter->sea_state = 5;
  radar.clutter->mti.emplace();
  radar.clutter->mti->surface_spread_mps = 0.02;
  const auto scenario = lineWith(radar);
  // eastwards from 12 km, at the first blind speed, twice that in the second half
  const double blind_mps = radar.waveform->firstBlindSpeed_mps(radar.frequency_hz);
  scenario::Platform aircraft = scenario->platforms[0];
  const double east_m[] = {12e3, 12e3 + 5 * blind_mps, 12e3 + 12.5 * blind_mps};
  const double times_s[] = {0, 5, 10};
  const scenario::TrackPoint point = aircraft.track[0];
  aircraft.track.clear();
  for (int n = 0; n < 3; ++n) {
    const GeodeticPosition at = pointAt(*scenario, east_m[n], 0);
    aircraft.track.push_back(point);
    aircraft.track.back().t_s = times_s[n];
    aircraft.track.back().position.latitude_deg = at.latitude_deg;
    aircraft.track.back().position.longitude_deg = at.longitude_deg;
    aircraft.track.back().position.height_ellipsoid_m = at.height_ellipsoid_m;
  }
  scenario->platforms.push_back(aircraft);
  scenario::Target target;
  target.platform = 1;
  target.rcs_m2 = radar.receiver.target_rcs_m2;
  scenario->targets.push_back(target);
  LinkOptions options;
  options.times_s = {1, 6, 10};
  options.emitters = {0};
  options.targets = {0};
  const LinkReport report = computeLinks(scenario, nullptr, options);
  const std::vector<DetectionRow>& rows = report.detections.at(0).rows;
  EXPECT_NEAR(*rows[0].radial_speed_mps, blind_mps, 0.01);
  EXPECT_LT(rows[0].detection_probability, 1e-3) << "a blind speed";
  EXPECT_NEAR(*rows[1].radial_speed_mps, 1.5 * blind_mps, 0.02);
  EXPECT_NEAR(*rows[2].radial_speed_mps, 1.5 * blind_mps, 0.02) << "the end of the track";
  EXPECT_GT(rows[1].sclnr_db, rows[0].sclnr_db + 30);
  EXPECT_NEAR(rows[1].snr_db + ratioToDb(2), rows[1].sclnr_db, 0.1) << "the filter's largest response";
  EXPECT_GT(rows[1].detection_probability, 0.5);
}

TEST(CudaClutter, EqualsCpu) {
  EMSCAPE_NEEDS_GPU();
  const auto terrain = std::make_shared<MadeTerrain>(44.5, -71.5, 1);
  for (const auto& antenna :
       {scenario::makeIsotropic(3), scenario::makeGaussian(30, 3, 6, -40),
        scenario::makeCosecant2(32, 3, 5, 40, -45), scenario::makePhasedArray(28, 24, 24, 0.5, 1)}) {
    auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {40e3, 40e3, 5000}, {40, 40, 20});
    scenario->terrain = scenario::TerrainSpec{};
    scenario->output.quantities = {"sclnr_db"};
    scenario->output.radar_look = scenario::RadarAim::target;
    scenario->atmosphere.rain_mm_h = 2;
    scenario::Emitter radar = cluttered(radarOf(antenna));
    radar.power_w = 2e5;
    radar.clutter->land_gamma_db = -10;
    radar.clutter->rain = true;
    addEmitter(*scenario, {44.45, -71.52, 0}, radar);
    scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario->platforms[0].track[0].position.height_agl_m = 20;
    FieldOptions on_cpu, on_gpu;
    on_cpu.backend = Backend::cpu;
    on_gpu.backend = Backend::cuda;
    const auto expected = solve(scenario, terrain, on_cpu), found = solve(scenario, terrain, on_gpu);
    int other = 0;
    for (std::size_t v = 0; v < expected->values.size(); ++v)
      other += std::abs(expected->values[v] - found->values[v]) > 0.01f ? 1 : 0;
    EXPECT_LT(other, 40 * 40 * 20 / 1000);
  }
}

}  // namespace
}  // namespace emscape::emfield
