#include "study/compare/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "emscape/scenario/file/scenario_file.h"
#include "study/compare/changed_areas.h"
#include "study/files/map_metadata.h"
#include "study/maps/surface_maps.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::study {
namespace {

using ::testing::HasSubstr;

const MapHeight kLow{emfield::HeightReference::ground, 100};
constexpr double kTime_s = 80;  // the jammer is above the ridge

ComparedScenario jacksboro(const std::vector<scenario::Edit>& edits = {}) {
  ComparedScenario result;
  result.scenario = scenario::loadScenario(test::shippedScenario("jacksboro.yaml"), edits);
  result.terrain = loadTerrain(*result.scenario, areaOf(result.scenario->region));
  return result;
}

/// A comparison on pixels of 500 m, with its maps by name.
struct Compared {
  Compared(const ComparedScenario& a, const ComparedScenario& b, const std::vector<Product>& products)
      : grid(makeMapGrid(areaOf(a.scenario->region), 500, "utm")) {
    CompareRequest request;
    request.coverage = {{kLow}, products, scenario::Quantity::detection_probability, 0.5, {kTime_s}};
    comparison =
        computeComparison(a, b, grid, request, {}, [&](const Map& map) { maps.emplace(map.name, map); });
  }
  MapGrid grid;
  Comparison comparison;
  std::map<std::string, Map> maps;
};

TEST(Compare, NamesOfMapsAreKnownBeforeTheyAreComputed) {
  const ComparedScenario a = jacksboro();
  const MapGrid grid = makeMapGrid(areaOf(a.scenario->region), 5000, "utm");
  CompareRequest request;
  request.coverage = {{kLow, {emfield::HeightReference::mean_sea_level, 2000}},
                      {},
                      scenario::Quantity::detection_probability,
                      0.5,
                      {kTime_s, kTime_s + 10}};
  const std::set<Product> left_out{Product::best, Product::margin, Product::cause, Product::min_height};
  for (const ProductInfo& product : productTable()) {
    if (left_out.count(product.product) == 0) request.coverage.products.push_back(product.product);
  }
  std::set<std::string> expected, changes, made;
  for (CoverageMap& map : outlinesOf(request.coverage)) {
    expected.insert(fileNameOf(map));
    map.name = changeNameOf(map.product);
    changes.insert(fileNameOf(map));
  }
  computeCoverage(a.scenario, a.terrain, grid, request.coverage, {},
                  [&](const CoverageMap& map) { made.insert(fileNameOf(map)); });
  EXPECT_EQ(made, expected);
  made.clear();
  computeComparison(a, a, grid, request, {}, [&](const Map& map) { made.insert(fileNameOf(map)); });
  EXPECT_EQ(made, changes);
  request.coverage.products = {Product::min_height, Product::cause};
  expected.clear();
  for (const CoverageMap& map : outlinesOf(request.coverage)) expected.insert(fileNameOf(map));
  EXPECT_THAT(expected,
              ::testing::ElementsAre("cause_agl100m_t80s", "cause_agl100m_t90s", "cause_msl2000m_t80s",
                                     "cause_msl2000m_t90s", "min_height_t80s", "min_height_t90s"));
}

TEST(Compare, EqualScenariosHaveNoChange) {
  const ComparedScenario a = jacksboro();
  const Compared same(a, jacksboro(), {Product::covered, Product::value, Product::count});
  ASSERT_EQ(same.comparison.rows.size(), 3u);
  const ComparisonRow& covered = same.comparison.rows[0];
  EXPECT_TRUE(covered.is_area);
  EXPECT_GT(covered.area_a_m2, 0);
  EXPECT_EQ(covered.area_a_m2, covered.area_b_m2);
  EXPECT_EQ(covered.gained_m2, 0);
  EXPECT_EQ(covered.lost_m2, 0);
  EXPECT_EQ(same.comparison.rows[1].min_difference, 0);
  EXPECT_EQ(same.comparison.rows[1].max_difference, 0);
  EXPECT_TRUE(same.comparison.changed_areas.empty());
  for (const float change : same.maps.at("covered_change").values) {
    EXPECT_TRUE(std::isnan(change) || change == 0 || change == kKept);
  }
}

TEST(Compare, WithoutJammersGainsTheAreaOfJamLoss) {
  const ComparedScenario jammed = jacksboro(), quiet = jacksboro({{"emitters.jammer.active_s", "[[0, 1]]"}});
  double jam_loss_m2 = 0;
  const MapGrid grid = makeMapGrid(areaOf(jammed.scenario->region), 500, "utm");
  computeCoverage(jammed.scenario, jammed.terrain, grid,
                  {{kLow}, {Product::jam_loss}, scenario::Quantity::detection_probability, 0.5, {kTime_s}},
                  {}, [&](const CoverageMap& map) { jam_loss_m2 = map.class_area_m2; });
  const Compared off(jammed, quiet, {Product::covered, Product::value});
  const ComparisonRow& covered = off.comparison.rows[0];
  EXPECT_GT(jam_loss_m2, 1e6);
  EXPECT_NEAR(covered.gained_m2 / jam_loss_m2, 1, 1e-9);
  EXPECT_EQ(covered.lost_m2, 0);
  EXPECT_NEAR(covered.area_b_m2 - covered.area_a_m2, covered.gained_m2, 1);
  // In the other direction it is lost.
  const Compared on(quiet, jammed, {Product::covered});
  EXPECT_EQ(on.comparison.rows[0].lost_m2, covered.gained_m2);
  EXPECT_EQ(on.comparison.rows[0].gained_m2, 0);
}

TEST(Compare, DifferencesOfLevelsHaveNoFloorOfALevel) {
  const ComparedScenario a = jacksboro(), b = jacksboro({{"emitters.jammer.power_w", "1"}});
  CompareRequest request;
  request.coverage = {{kLow}, {Product::value}, scenario::Quantity::power_density_dbwm2, -60, {kTime_s}};
  std::vector<Map> maps;
  computeComparison(a, b, makeMapGrid(areaOf(a.scenario->region), 1000, "utm"), request, {},
                    [&](const Map& map) { maps.push_back(map); });
  ASSERT_EQ(maps.size(), 1U);
  EXPECT_EQ(maps[0].unit, "dB");
  EXPECT_THAT(maps[0].subject, HasSubstr("difference B - A of "));
  EXPECT_EQ(maps[0].floor, std::nullopt);
  EXPECT_EQ(noValueText(maps[0]), "NaN: A, B or both have no value");
}

TEST(Compare, ExplainsLargestChanges) {
  const ComparedScenario high = jacksboro({{"platforms.ridge site.position.height_agl_m", "60"}});
  const Compared compared(jacksboro(), high, {Product::value, Product::covered});
  ASSERT_FALSE(compared.comparison.changed_areas.empty());
  double last_m2 = HUGE_VAL;
  for (const ChangedArea& area : compared.comparison.changed_areas) {
    if (!area.is_gained) break;
    EXPECT_LE(area.area_m2, last_m2);
    last_m2 = area.area_m2;
    const long long pixel = compared.grid.pixelAt(area.latitude_deg, area.longitude_deg);
    ASSERT_GE(pixel, 0);
    EXPECT_EQ(compared.maps.at("covered_change").values[static_cast<std::size_t>(pixel)], kGained);
    EXPECT_FALSE(area.emitter.empty());
    ASSERT_TRUE(area.a.value && area.b.value);
    EXPECT_LT(*area.a.value, 0.5);
    // Both radars together may reach what none does alone.
    EXPECT_GT(*area.b.value, 0.25);
    EXPECT_NE(area.a.verdict, area.b.verdict);
  }
}

TEST(Compare, RefusesIndices) {
  EXPECT_THAT(test::errorOf([] { Compared(jacksboro(), jacksboro(), {Product::best}); }),
              HasSubstr("'best' is an index"));
  CompareRequest request;
  request.coverage = {{kLow}, {Product::value}, scenario::Quantity::dominant_emitter, 0, {kTime_s}};
  const auto scenario = jacksboro().scenario;
  EXPECT_THAT(test::errorOf([&] { checkRequest(request, *scenario, *scenario); }),
              HasSubstr("quantity 'dominant_emitter' is an index"));
}

TEST(LargestAreas, AreConnectedAndCutOffAtTheEdge) {
  MapGrid grid;
  grid.width = 5;
  grid.height = 4;
  grid.positions.resize(20);
  for (std::size_t p = 0; p < 20; ++p) grid.positions[p] = {double(p / 5), double(p % 5)};
  grid.areas_m2.assign(20, 100);
  // The two at the ends of rows do not touch.
  const std::vector<float> changes{1,   1, 0, 0, 1,  //
                                   1,   0, 0, 1, 2,  //
                                   0,   0, 0, 2, 2,  //
                                   NAN, 0, 0, 0, 1};
  const std::vector<ChangedArea> gained = largestAreas(grid, changes, kGained, 2);
  ASSERT_EQ(gained.size(), 2u);
  EXPECT_EQ(gained[0].area_m2, 300);
  EXPECT_TRUE(gained[0].is_gained);
  EXPECT_EQ(gained[0].latitude_deg, 0);
  EXPECT_EQ(gained[0].longitude_deg, 0);
  EXPECT_EQ(gained[1].area_m2, 100);
  EXPECT_EQ(largestAreas(grid, changes, kGained, 9).size(), 4u);
  EXPECT_EQ(largestAreas(grid, changes, kLost, 9).size(), 1u);
}

}  // namespace
}  // namespace emscape::study
