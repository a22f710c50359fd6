#include "emscape/study/maps/coverage.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/file/scenario_file.h"
#include "study/files/geotiff.h"
#include "study/maps/warnings.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Maps of a shipped scenario by product, height and time.
class CoverageOf {
 public:
  CoverageOf(const std::string& name, double cell_m, CoverageRequest request)
      : scenario(scenario::loadScenario(test::shippedScenario(name))),
        area(areaOf(scenario->region)),
        grid(makeMapGrid(area, cell_m, "utm")),
        terrain(loadTerrain(*scenario, area)) {
    warnings = computeCoverage(scenario, terrain, grid, request, {},
                               [&](CoverageMap map) { maps.push_back(std::move(map)); });
  }

  const CoverageMap& find(Product product, const MapHeight& height, std::optional<double> time_s = {}) const {
    for (const CoverageMap& map : maps) {
      if (map.product == product && map.height && map.height->metres == height.metres &&
          map.height->reference == height.reference && map.time_s == time_s) {
        return map;
      }
    }
    throw std::runtime_error("no such map");
  }

  std::shared_ptr<const scenario::Scenario> scenario;
  MapArea area;
  MapGrid grid;
  scenario::TerrainPtr terrain;
  std::vector<CoverageMap> maps;
  std::vector<std::string> warnings;
};

const MapHeight kLow{emfield::HeightReference::ground, 100},
    kHigh{emfield::HeightReference::mean_sea_level, 1500};

TEST(Coverage, WarnsOfBeamsBetweenTimesOfAProduct) {
  const auto warningsOf = [](scenario::Quantity quantity, Product product) {
    return CoverageOf("jacksboro.yaml", 3000, {{kLow}, {product}, quantity, 0.5, {0, 6, 12}}).warnings;
  };
  const auto unlit = ::testing::Contains(HasSubstr("of its azimuths"));
  EXPECT_THAT(warningsOf(scenario::Quantity::power_density_dbwm2, Product::fraction), unlit);
  EXPECT_THAT(warningsOf(scenario::Quantity::power_density_dbwm2, Product::covered), ::testing::Not(unlit));
  EXPECT_THAT(warningsOf(scenario::Quantity::detection_probability, Product::fraction), ::testing::Not(unlit))
      << "radars look at the target";
}

TEST(Coverage, WarnsOfAJammerThatIsSilentAtItsTime) {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jacksboro.yaml")));
  for (scenario::Emitter& emitter : scenario->emitters)
    if (emitter.kind == scenario::EmitterKind::jammer) emitter.active_s = {{0, 40}};
  const MapGrid grid = makeMapGrid(areaOf(scenario->region), 3000, "utm");
  const scenario::TerrainPtr terrain = loadTerrain(*scenario, areaOf(scenario->region));
  const auto warningsAt = [&](double time_s) {
    return computeCoverage(
        scenario, terrain, grid,
        {{kLow}, {Product::covered}, scenario::Quantity::detection_probability, 0.5, {time_s}}, {},
        [](const CoverageMap&) {});
  };
  EXPECT_THAT(warningsAt(60), Contains(HasSubstr("the maps of this time have none of its jamming")));
  EXPECT_THAT(warningsAt(20), Not(Contains(HasSubstr("none of its jamming"))));
}

TEST(Coverage, WarnsOfTimesWithoutAnActiveRadar) {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jacksboro.yaml")));
  for (scenario::Emitter& emitter : scenario->emitters)
    if (emitter.kind == scenario::EmitterKind::radar) emitter.active_s = {{0, 40}};
  const MapGrid grid = makeMapGrid(areaOf(scenario->region), 3000, "utm");
  const scenario::TerrainPtr terrain = loadTerrain(*scenario, areaOf(scenario->region));
  const auto warningsOf = [&](scenario::Quantity quantity, std::vector<double> times_s) {
    return computeCoverage(scenario, terrain, grid,
                           {{kLow}, {Product::covered}, quantity, 0.5, std::move(times_s)}, {},
                           [](const CoverageMap&) {});
  };
  EXPECT_THAT(
      warningsOf(scenario::Quantity::detection_probability, {0, 40}),
      Contains("no radar is active at t = 40 s (active_s, blink, or outside its track): the maps of this "
               "time are empty"));
  EXPECT_THAT(
      warningsOf(scenario::Quantity::snr_db, {20, 60, 100}),
      Contains("no radar is active at 2 of 3 times, first at t = 60 s (active_s, blink, or outside its "
               "track): the maps of these times are empty"));
  const auto inactive = Contains(HasSubstr("is active"));
  EXPECT_THAT(warningsOf(scenario::Quantity::detection_probability, {0, 39}), Not(inactive));
  EXPECT_THAT(warningsOf(scenario::Quantity::power_density_dbwm2, {60}), Not(inactive))
      << "of other emitters";
}

TEST(Coverage, SaysWhichPartOfTheMapIsBeyondTheInstrumentedRange) {
  using namespace emfield::testing;
  scenario::Emitter radar = trackingRadar();
  radar.propagation.model = propagation::PropagationModel::free_space;
  const auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {20e3, 20e3, 4000}, {10, 10, 4});
  addEmitter(*scenario, {44.5, -71.5, 500}, radar);
  const MapGrid grid = makeMapGrid(areaOf(scenario->region), 500, "local");
  const auto warningsFor = [&](double range_m) {
    const auto limited = std::make_shared<scenario::Scenario>(*scenario);
    limited->emitters[0].waveform.emplace();
    limited->emitters[0].waveform->prf_hz = 1000;
    limited->emitters[0].waveform->pulse_width_s = 1e-6;
    limited->emitters[0].waveform->instrumented_range_m = range_m;
    CoverageRequest request;
    request.heights = {kHigh};
    request.products = {Product::covered};
    request.times_s = {0};
    return computeCoverage(limited, nullptr, grid, request, {}, [](CoverageMap) {});
  };
  // A circle of 5 km has 78.5 of about 400 km2.
  EXPECT_THAT(warningsFor(5e3), Contains(::testing::AllOf(HasSubstr("beyond the instrumented range of"),
                                                          HasSubstr("km2 of the map"), HasSubstr("5 km"))));
  EXPECT_THAT(warningsFor(50e3), Not(Contains(HasSubstr("instrumented range"))));
}

TEST(Coverage, WarningsOfSeveralTimesAreKeptOnceWithoutTheirCounts) {
  std::set<std::string> all{"a"};
  addOnce(all, {"a (3 times)", "b (21 times)", "c (all times)", "d ( times)", "e (2 times) f", "g"});
  EXPECT_THAT(all, ::testing::ElementsAre("a", "b", "c (all times)", "d ( times)", "e (2 times) f", "g"));
}

TEST(Coverage, KeepsTheWarningsOfEachTimeOfSeveralScenarios) {
  using namespace emfield::testing;
  const auto terrain = std::make_shared<const MadeTerrain>(44.5, -71.5, 1.0, 0.05);
  scenario::Emitter radar = trackingRadar(), jammer = jammerOf(100);
  radar.active_s = {{0, 40}};
  jammer.propagation.model = propagation::PropagationModel::horizon;
  const auto weak = emptyScenario(FrameKind::altitude, 44.5, -71.5, {10e3, 10e3, 4000}, {10, 10, 4});
  addEmitter(*weak, {44.5, -71.5, 2500}, radar);
  addEmitter(*weak, {44.97, -71.03, 2500}, jammer);  // behind the hole
  const auto strong = std::make_shared<scenario::Scenario>(*weak);
  strong->emitters[1].power_w *= 2;
  emfield::FieldOptions options;
  options.allow_missing_terrain = true;
  const MapGrid grid = makeMapGrid(areaOf(weak->region), 2000, "utm");
  CoverageSolver solver(
      grid, {{{kHigh}, {Product::fraction}, scenario::Quantity::jammer_to_signal_db, 0, {0, 60}}}, options);
  const auto warnings =
      solver.compute({weak, strong}, terrain, [](std::size_t, std::size_t, CoverageMap) {}, {});
  ASSERT_EQ(warnings.size(), 2u);
  for (const auto& of_scenario : warnings) {
    EXPECT_THAT(of_scenario, Contains(HasSubstr("counted as a free path")))
        << "at the first time alone: at the second no radar is active";
  }
}

TEST(Coverage, RadarsLookAtTargetsAlsoInAScenarioOfIntervals) {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jacksboro.yaml")));
  const MapGrid grid = makeMapGrid(areaOf(scenario->region), 3000, "utm");
  const scenario::TerrainPtr terrain = loadTerrain(*scenario, areaOf(scenario->region));
  const auto valuesOver = [&](scenario::IntervalKind kind, scenario::Quantity quantity) {
    scenario->output.interval = {kind, {}, {}};
    std::vector<float> values;
    computeCoverage(scenario, terrain, grid, {{kLow}, {Product::value}, quantity, 0.5, {10}}, {},
                    [&](const CoverageMap& map) { values = map.values; });
    for (float& value : values)
      if (std::isnan(value)) value = -999;
    return values;
  };
  using scenario::IntervalKind;
  using scenario::Quantity;
  const auto probability = valuesOver(IntervalKind::instant, Quantity::detection_probability);
  EXPECT_EQ(valuesOver(IntervalKind::max_hold, Quantity::detection_probability), probability);
  EXPECT_EQ(valuesOver(IntervalKind::mean, Quantity::detection_probability), probability);
  EXPECT_EQ(valuesOver(IntervalKind::max_hold, Quantity::jammer_to_signal_db),
            valuesOver(IntervalKind::instant, Quantity::jammer_to_signal_db));
  EXPECT_NE(valuesOver(IntervalKind::max_hold, Quantity::power_density_dbwm2),
            valuesOver(IntervalKind::instant, Quantity::power_density_dbwm2))
      << "the field of an interval";
}

TEST(Coverage, WarnsOfPixelsOfAnotherSizeOnTheGround) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("jacksboro.yaml"));
  const auto warningsIn = [&](const std::string& crs) {
    return computeCoverage(scenario, loadTerrain(*scenario, areaOf(scenario->region)),
                           makeMapGrid(areaOf(scenario->region), 3000, crs),
                           {{kLow}, {Product::covered}, scenario::Quantity::snr_db, 0, {0}}, {},
                           [](const CoverageMap&) {});
  };
  const auto scaled = Contains(HasSubstr("on the ground"));
  for (const char* crs : {"utm", "local"}) EXPECT_THAT(warningsIn(crs), Not(scaled)) << crs;
  // The scale of Mercator's projection is that of the parallel: cos(36.25 degrees) = 0.806, here with the
  // flattening of the earth.
  EXPECT_THAT(warningsIn("EPSG:3857"), Contains(HasSubstr("pixels of 3000 m in EPSG:3857 are 24")));
  EXPECT_THAT(warningsIn("EPSG:32633"), scaled) << "a zone of Europe";
}

TEST(Coverage, AnAreaWithoutAPixelIsRefused) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("jacksboro.yaml"));
  const MapArea area = circularArea({36.3, -84.2, 10});
  const MapGrid grid = makeMapGrid(area, 5000, "utm");
  const auto compute = [&] {
    computeCoverage(scenario, loadTerrain(*scenario, area), grid,
                    {{kLow}, {Product::covered}, scenario::Quantity::snr_db, 10, {0}}, {},
                    [](const CoverageMap&) {});
  };
  EXPECT_THAT(test::errorOf(compute), HasSubstr("no pixel of 5000 m has its centre in the area"));
}

TEST(Coverage, IndicesAndCountsAreMappedAsWholeNumbers) {
  const auto mapOf = [](scenario::Quantity quantity) {
    return CoverageOf("jacksboro.yaml", 3000, {{kLow}, {Product::value}, quantity, 1, {80}}).maps.front();
  };
  const CoverageMap emitters = mapOf(scenario::Quantity::dominant_emitter);
  EXPECT_EQ(emitters.kind, MapKind::category);
  ASSERT_EQ(emitters.labels.size(), 4u);
  EXPECT_EQ(emitters.labels[3], "jammer");
  EXPECT_EQ(mapOf(scenario::Quantity::dominant_model).kind, MapKind::category);
  EXPECT_EQ(mapOf(scenario::Quantity::emitter_count).kind, MapKind::count);
}

TEST(Coverage, TitlesAreInWordsAndNamesAreKeys) {
  const CoverageMap map =
      CoverageOf("jacksboro.yaml", 3000, {{kLow}, {Product::max_range}, scenario::Quantity::snr_db, 10, {80}})
          .maps.front();
  EXPECT_EQ(map.name, "max_range");
  EXPECT_EQ(map.title, "maximum range");
  EXPECT_EQ(map.description, "maximum range (SNR >= 10 dB) at 100 m above ground");
  EXPECT_EQ(titleOf(Product::value, scenario::Quantity::detection_probability), "detection probability");
  EXPECT_EQ(titleOf(Product::min_height, scenario::Quantity::snr_db), "minimum height above ground");
}

TEST(Coverage, PixelEqualsProfileAtItsPosition) {
  CoverageRequest request{
      {kLow, kHigh}, {Product::value}, scenario::Quantity::power_density_dbwm2, -60, {80}};
  const CoverageOf coverage("jamming.yaml", 400, request);
  // One emitter alone, so that the sum is its budget.
  const scenario::Snapshot snapshot = scenario::snapshotAt(coverage.scenario, coverage.terrain.get(), 80);
  std::mt19937 random(5);
  int compared = 0;
  for (int n = 0; n < 60; ++n) {
    const std::size_t pixel = random() % coverage.grid.pixels();
    const auto [latitude_deg, longitude_deg] = coverage.grid.positions[pixel];
    if (std::isnan(latitude_deg)) continue;
    for (const MapHeight& height : {kLow, kHigh}) {
      const float value = coverage.find(Product::value, height, 80).values[pixel];
      if (std::isnan(value)) continue;
      const double ground_m =
          coverage.terrain != nullptr ? coverage.terrain->heightMsl_m(latitude_deg, longitude_deg) : 0;
      const double height_m =
          height.metres + (height.reference == emfield::HeightReference::ground ? ground_m : 0);
      const emfield::PathEnd end{
          {latitude_deg, longitude_deg, height_m + geoidUndulation_m(latitude_deg, longitude_deg)}, height_m};
      double sum = 0;
      for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
        if (!snapshot.emitters[e].active) continue;
        const auto budget =
            emfield::powerBudget(snapshot, static_cast<int>(e), end,
                                 coverage.scenario->emitters[e].propagation.model, coverage.terrain.get());
        sum += std::pow(10, budget.find("power_density_dbwm2")->value / 10);
      }
      const double expected = std::max(10 * std::log10(sum), coverage.scenario->output.floor);
      EXPECT_NEAR(static_cast<double>(value), expected, 0.01);
      ++compared;
    }
  }
  EXPECT_GT(compared, 80);
}

// Large pixels on slopes below the beam: an offset of two metres changes the value by 0.05 dB.
TEST(Coverage, LargePixelEqualsPathToItsProjectedCentre) {
  const CoverageOf coverage("jamming.yaml", 2000,
                            {{kLow}, {Product::value}, scenario::Quantity::snr_db, 10, {40}});
  auto at_targets = std::make_shared<scenario::Scenario>(*coverage.scenario);
  at_targets->output.radar_look = scenario::RadarAim::target;
  const scenario::Snapshot snapshot = scenario::snapshotAt(at_targets, coverage.terrain.get(), 40);
  const MapGrid& grid = coverage.grid;
  const std::vector<float>& values = coverage.find(Product::value, kLow, 40).values;
  int compared = 0;
  for (std::size_t p = 0; p < grid.pixels(); p += 2) {
    if (std::isnan(values[p]) || static_cast<double>(values[p]) <= at_targets->output.floor) continue;
    const auto width = static_cast<std::size_t>(grid.width);
    const double x_m = grid.left_m + (static_cast<double>(p % width) + 0.5) * grid.cell_m,
                 y_m = grid.top_m - (static_cast<double>(p / width) + 0.5) * grid.cell_m;
    double latitude_deg = 0, longitude_deg = 0;
    GeographicLib::UTMUPS::Reverse(16, true, x_m, y_m, latitude_deg, longitude_deg);
    const double height_m = kLow.metres + coverage.terrain->heightMsl_m(latitude_deg, longitude_deg);
    const emfield::PathEnd end{
        {latitude_deg, longitude_deg, height_m + geoidUndulation_m(latitude_deg, longitude_deg)}, height_m};
    const auto budget = emfield::pathBudget(snapshot, 0, end, at_targets->emitters[0].propagation.model,
                                            coverage.terrain.get());
    EXPECT_NEAR(static_cast<double>(values[p]), budget.find("snr_db")->value, 0.01) << "pixel " << p;
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

TEST(Coverage, ProductsFollowFromTheValues) {
  const std::vector<double> times_s{70, 80, 90};
  CoverageRequest request{{kLow},
                          {Product::value, Product::covered, Product::count, Product::redundancy,
                           Product::best, Product::max_range, Product::jam_loss, Product::burn_through,
                           Product::fraction, Product::first_detection},
                          scenario::Quantity::detection_probability,
                          0.5,
                          times_s};
  const CoverageOf coverage("jacksboro.yaml", 500, request);
  double lost_m2 = 0;
  std::vector<int> times_covered(coverage.grid.pixels(), 0);
  for (const double time_s : times_s) {
    const CoverageMap& value = coverage.find(Product::value, kLow, time_s);
    const CoverageMap& covered = coverage.find(Product::covered, kLow, time_s);
    const CoverageMap& count = coverage.find(Product::count, kLow, time_s);
    const CoverageMap& best = coverage.find(Product::best, kLow, time_s);
    const CoverageMap& lost = coverage.find(Product::jam_loss, kLow, time_s);
    const CoverageMap& spare = coverage.find(Product::redundancy, kLow, time_s);
    const CoverageMap& range = coverage.find(Product::max_range, kLow, time_s);
    const CoverageMap& burnt = coverage.find(Product::burn_through, kLow, time_s);
    const scenario::Snapshot snapshot =
        scenario::snapshotAt(coverage.scenario, coverage.terrain.get(), time_s);
    double area_m2 = 0;
    for (std::size_t p = 0; p < coverage.grid.pixels(); ++p) {
      ASSERT_EQ(std::isnan(value.values[p]), std::isnan(coverage.grid.positions[p].latitude_deg));
      if (std::isnan(value.values[p])) continue;
      ASSERT_EQ(covered.values[p], value.values[p] >= 0.5f ? 1 : 0);
      ASSERT_EQ(best.values[p] >= 0, count.values[p] > 0);
      ASSERT_EQ(burnt.values[p], covered.values[p] == 1 ? 2 : lost.values[p]);
      ASSERT_EQ(spare.values[p], std::max(count.values[p] - 1, 0.0f));
      ASSERT_EQ(std::isnan(range.values[p]), count.values[p] == 0);
      if (count.values[p] == 1) {
        const auto [latitude_deg, longitude_deg] = coverage.grid.positions[p];
        const GeodeticPosition& radar = snapshot.emitters[static_cast<int>(best.values[p])].position;
        const double distance_m =
            geodesicInverse(radar.latitude_deg, radar.longitude_deg, latitude_deg, longitude_deg).distance_m;
        ASSERT_NEAR(static_cast<double>(range.values[p]), distance_m, 0.1);
      }
      if (count.values[p] > 0) {
        ASSERT_EQ(covered.values[p], 1) << "two radars detect more than one";
      }
      if (covered.values[p] == 1) {
        ASSERT_EQ(lost.values[p], 0);
        area_m2 += static_cast<double>(coverage.grid.areas_m2[p]);
        ++times_covered[p];
      }
    }
    EXPECT_NEAR(covered.class_area_m2, area_m2, 1);
    EXPECT_GT(covered.class_area_m2, 0);
    lost_m2 = lost.class_area_m2;
  }
  EXPECT_GT(lost_m2, 0) << "the jammer is above the ridge";
  const CoverageMap& first = coverage.find(Product::first_detection, kLow);
  const CoverageMap& fraction = coverage.find(Product::fraction, kLow);
  for (std::size_t p = 0; p < coverage.grid.pixels(); ++p) {
    if (times_covered[p] == 3) {
      ASSERT_EQ(first.values[p], 70);
      ASSERT_EQ(fraction.values[p], 1);
    } else if (times_covered[p] == 0) {
      ASSERT_TRUE(std::isnan(first.values[p]));
    }
  }
}

TEST(Coverage, MinHeightIsLowestCoveredHeight) {
  // Near ridges there are a few positions where a lower height is visible and a higher one is not.
  const CoverageOf coverage(
      "jacksboro.yaml", 1000,
      {{kLow}, {Product::min_height}, scenario::Quantity::detection_probability, 0.5, {10}});
  ASSERT_EQ(coverage.maps.size(), 1u);
  const std::vector<float>& least_m = coverage.maps[0].values;
  EXPECT_GT(coverage.maps[0].class_area_m2, 0);
  EXPECT_NEAR(coverage.maps[0].known_area_m2,
              coverage.maps[0].class_area_m2 + *coverage.maps[0].unreached_area_m2, 1);
  auto edited = std::make_shared<scenario::Scenario>(*coverage.scenario);
  edited->output.radar_look = scenario::RadarAim::target;
  edited->output.quantities = {"detection_probability"};
  auto surface = std::make_shared<emfield::Surface>();
  surface->width = coverage.grid.width;
  surface->height = coverage.grid.height;
  surface->positions = coverage.grid.positions;
  surface->heights_m = {0, 1};  // the metre below, and the height itself
  for (const float height_m : least_m) {
    surface->offsets_m.push_back(height_m >= 1 ? height_m - 1 : 0);
  }
  emfield::FieldOptions options;
  options.surface = surface;
  emfield::FieldSolver solver(edited, coverage.terrain, options);
  solver.update(scenario::snapshotAt(edited, coverage.terrain.get(), 10));
  const auto volume = solver.volumes().front().host();
  int found = 0, above = 0;
  for (std::size_t p = 0; p < least_m.size(); ++p) {
    if (std::isnan(least_m[p])) continue;
    ++found;
    if (least_m[p] < 1) continue;
    ++above;
    EXPECT_LT(volume->values[p], 0.5f) << least_m[p];
    EXPECT_GE(volume->values[least_m.size() + p], 0.5f) << least_m[p];
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(above, 200);
}

TEST(Coverage, MapsOfCausesTellTheirProgress) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("quick.yaml"));
  const MapArea area = areaOf(scenario->region);
  const MapGrid grid = makeMapGrid(area, scenario->region.size_m.x / 20, "utm");
  std::vector<double> fractions;
  computeCoverage(
      scenario, loadTerrain(*scenario, area), grid,
      {{{emfield::HeightReference::ground, 300}, {emfield::HeightReference::ground, 900}},
       {Product::cause},
       scenario::Quantity::detection_probability,
       0.5,
       {0, 1}},
      {}, [](const CoverageMap&) {},
      [&](const std::string&, double fraction) { fractions.push_back(fraction); });
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.front(), 0);
  EXPECT_EQ(fractions.back(), 1);
  for (std::size_t n = 1; n < fractions.size(); ++n) {
    // of six steps (the fields of two times, two maps of each) a field is one, and the end of a map
    EXPECT_LT(fractions[n] - fractions[n - 1], 1.1 / 6) << n;
  }
  EXPECT_GT(fractions.size(), 40u);
}

TEST(Coverage, RefusesProductsThatTheQuantityOrTheTimesDoNotHave) {
  const auto messageOf = [](Product product, scenario::Quantity quantity) {
    return test::errorOf([&] { CoverageOf("quick.yaml", 5000, {{kLow}, {product}, quantity, 0, {0}}); });
  };
  using scenario::Quantity;
  EXPECT_THAT(messageOf(Product::margin, Quantity::detection_probability), HasSubstr("decibels"));
  EXPECT_THAT(messageOf(Product::jam_loss, Quantity::power_density_dbwm2), HasSubstr("jamming"));
  EXPECT_THAT(messageOf(Product::best, Quantity::emitter_count), HasSubstr("one value for all"));
  EXPECT_THAT(messageOf(Product::covered, Quantity::dominant_emitter), HasSubstr("index"));
  EXPECT_THAT(messageOf(Product::fraction, Quantity::power_density_dbwm2), HasSubstr("two times"));
  EXPECT_THAT(test::errorOf([] { productNamed("gap"); }), HasSubstr("longest_gap"));
}

TEST(Coverage, RefusesMeaninglessThresholdsAndTimes) {
  const auto messageOf = [](double threshold, const std::vector<double>& times_s) {
    return test::errorOf([&] {
      CoverageOf("quick.yaml", 5000,
                 {{kLow}, {Product::covered}, scenario::Quantity::detection_probability, threshold, times_s});
    });
  };
  EXPECT_THAT(messageOf(2, {0}), HasSubstr("threshold 2 of detection_probability must be between 0 and 1"));
  EXPECT_THAT(messageOf(NAN, {0}),
              HasSubstr("threshold nan of detection_probability must be a finite number"));
  EXPECT_THAT(messageOf(0.5, {0, 2, 1}), HasSubstr("times of maps must ascend; 1 s follows 2 s"));
  EXPECT_THAT(messageOf(0.5, {NAN}), HasSubstr("time nan s of a map"));
}

TEST(Coverage, HeightsAreListsAndRanges) {
  const std::vector<MapHeight> heights = parseHeights("agl:30,150;msl:500:1500:500");
  ASSERT_EQ(heights.size(), 5u);
  EXPECT_EQ(describe(heights[1]), "150 m above ground");
  EXPECT_EQ(describe(heights[4]), "1500 m above mean sea level");
  EXPECT_EQ(nameOf(heights[2]), "msl500m");
  for (const char* text :
       {"", "30", "agl:", "agl:x", "msl:1:2", "msl:3:2:1", "agl:1:2:0", "agl:-1", "msl:1e9", "agl:0:1e5:1"}) {
    EXPECT_THAT(test::errorOf([&] { parseHeights(text); }), HasSubstr("heights '" + std::string(text)))
        << text;
  }
}

TEST(Coverage, GeoTiffContainsMapAndDescription) {
  const test::TemporaryFolder folder;
  const CoverageOf coverage(
      "quick.yaml", 2000,
      {{kLow}, {Product::value, Product::best}, scenario::Quantity::power_density_dbwm2, -90, {0}});
  for (const CoverageMap& map : coverage.maps) {
    const std::filesystem::path file = folder.path() / "map.tif";
    writeGeoTiff(file, coverage.grid, map, {{"EMSCAPE_TIME_S", "0"}});
    GDALAllRegister();
    auto* const dataset = static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_ReadOnly));
    ASSERT_NE(dataset, nullptr);
    GDALRasterBand* const band = dataset->GetRasterBand(1);
    EXPECT_STREQ(band->GetDescription(), map.description.c_str());
    EXPECT_STREQ(band->GetUnitType(), map.unit.c_str());
    EXPECT_STREQ(dataset->GetMetadataItem("EMSCAPE_TIME_S"), "0");
    EXPECT_STREQ(dataset->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    double transform[6];
    ASSERT_EQ(dataset->GetGeoTransform(transform), CE_None);
    EXPECT_EQ(transform[0], coverage.grid.left_m);
    EXPECT_EQ(transform[3], coverage.grid.top_m);
    EXPECT_EQ(transform[1], 2000);
    std::vector<float> values(coverage.grid.pixels());
    ASSERT_EQ(band->RasterIO(GF_Read, 0, 0, coverage.grid.width, coverage.grid.height, values.data(),
                             coverage.grid.width, coverage.grid.height, GDT_Float32, 0, 0, nullptr),
              CE_None);
    for (std::size_t p = 0; p < values.size(); ++p) {
      if (map.product == Product::best) {
        ASSERT_EQ(values[p], map.values[p] >= 0 ? map.values[p] : 255);
      } else if (std::isnan(map.values[p])) {
        ASSERT_TRUE(std::isnan(values[p]));
      } else {
        ASSERT_EQ(values[p], map.values[p]);
      }
    }
    GDALClose(dataset);
  }
  EXPECT_THAT(test::errorOf([&] {
                writeGeoTiff(folder.path() / "none" / "map.tif", coverage.grid, coverage.maps[0], {});
              }),
              HasSubstr("none/map.tif"));
}

}  // namespace
}  // namespace emscape::study
