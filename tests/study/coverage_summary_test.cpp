// What the summary of a report says of its maps.
#include "study/report/coverage_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/terrain/terrain.h"
#include "tests/support/files.h"

namespace emscape::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A study of 100 km2 of jacksboro.yaml at 150 m above ground.
MapStudy smallStudy() {
  MapStudy study;
  study.scenarios = {scenario::loadScenario(test::shippedScenario("jacksboro.yaml"))};
  study.terrain = scenario::loadTerrain(*study.scenarios.front());
  auto grid = std::make_shared<MapGrid>();
  grid->areas_m2.assign(100, 1e6F);
  study.grid = grid;
  study.times_s = {80};
  study.heights = {{emfield::HeightReference::ground, 150}};
  return study;
}

MapRecord recordOf(const std::string& product, double class_km2, double known_km2,
                   std::vector<double> labels_m2 = {}) {
  MapRecord record;
  record.map.name = product;
  record.map.height = MapHeight{emfield::HeightReference::ground, 150};
  record.map.time_s = 80;
  record.summary.class_area_m2 = class_km2 * 1e6;
  record.summary.known_area_m2 = known_km2 * 1e6;
  record.summary.label_areas_m2 = std::move(labels_m2);
  return record;
}

TEST(CoverageSummary, NamesShareTargetThresholdAndTheUnknownPixels) {
  const MapStudy study = smallStudy();
  const std::vector<std::string> sentences = coverageSummary(study, {recordOf("covered", 40, 80)});
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_THAT(sentences[0], HasSubstr("At 150 m above ground, t = 80 s: '"));
  EXPECT_THAT(sentences[0], HasSubstr("detects a target of "));
  EXPECT_THAT(sentences[0],
              HasSubstr(" m² with a probability of at least 0.5 on 50.0 % of the area (40 km²)."));
  EXPECT_THAT(sentences[1], HasSubstr("80.0 % of the area"));
}

TEST(CoverageSummary, TheTargetIsThatOfTheRadarsThatAreOn) {
  MapStudy study = smallStudy();
  auto scenario = std::make_shared<scenario::Scenario>(*study.scenarios.front());
  scenario::Emitter off = scenario->emitters.front();
  off.name = "reserve";
  off.receiver.target_rcs_m2 = 77;
  off.active_s = {{1000, 1001}};
  scenario->emitters.push_back(off);
  study.scenarios = {scenario};
  EXPECT_THAT(coverageSummary(study, {recordOf("covered", 40, 80)}).front(),
              ::testing::Not(::testing::AnyOf(HasSubstr("77"), HasSubstr("reserve"))));
}

TEST(CoverageSummary, BurnThroughSaysWhatJammingTakesAway) {
  const MapStudy study = smallStudy();
  const std::vector<std::string> sentences =
      coverageSummary(study, {recordOf("burn_through", 40, 100, {50e6, 10e6, 40e6})});
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_THAT(sentences[0], HasSubstr(" on 40.0 % of the area (40 km²). Jamming by "));
  EXPECT_THAT(sentences[0], HasSubstr(" takes it away from another 10.0 % (10 km²)."));
  EXPECT_THAT(sentences[1], HasSubstr("known in all its pixels"));
  EXPECT_THAT(coverageSummary(study, {recordOf("burn_through", 40, 100, {60e6, 0, 40e6})}).front(),
              HasSubstr(" takes nothing away."));
}

TEST(CoverageSummary, OtherQuantitiesAreNamedWithTheirThreshold) {
  MapStudy study = smallStudy();
  study.quantity = scenario::Quantity::power_density_dbwm2;
  study.threshold = -60;
  EXPECT_THAT(coverageSummary(study, {recordOf("covered", 40, 100)}).front(),
              HasSubstr("power density is at least -60 dBW/m² on 40.0 %"));
}

TEST(CoverageSummary, SharesOfMinimumHeightsAreOfTheKnownPixels) {
  MapRecord record = recordOf("min_height", 20, 80);
  record.summary.min = 3;
  record.summary.max = 90;
  const std::vector<std::string> sentences = coverageSummary(smallStudy(), {record});
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[1],
              HasSubstr("On 25.0 % of the area (20 km²) a target is detected from some height on"));
  EXPECT_THAT(sentences[2], HasSubstr("known answer, 80.0 of 100.0 km², 80.0 % of the area"));
}

TEST(CoverageSummary, MapsWithoutAreasHaveNone) {
  EXPECT_THAT(coverageSummary(smallStudy(), {recordOf("value", 0, 100)}), ElementsAre());
}

TEST(CoverageSummary, ManyNamesAreCounted) {
  EXPECT_EQ(namesText({"a"}, "or", "{} radars"), "'a'");
  EXPECT_EQ(namesText({"a", "b", "c"}, "or", "{} radars"), "'a', 'b' or 'c'");
  EXPECT_EQ(namesText({"a", "b", "c", "d"}, "or", "one of {} radars"), "one of 4 radars");
}

}  // namespace
}  // namespace emscape::study
