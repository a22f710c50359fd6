// What decides that a point is not covered.
#include "emscape/emfield/link/path_cause.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/emfield/link/path_budget.h"

namespace emscape::emfield {
namespace {

using scenario::Quantity;
using ::testing::HasSubstr;

/// A radar's budget that needs 13 dB.
PathBudget radarBudget(double snr_db) {
  PathBudget budget;
  budget.terms = {{"snr_db", "", snr_db, "dB", ""},
                  {"required_snr_db", "", 13, "dB", ""},
                  {"detection_probability", "", snr_db >= 13 ? 0.9 : 0.1, "", ""}};
  return budget;
}
PathCause causeOfDetection(const PathBudget& budget) {
  return causeOf(budget, Quantity::detection_probability, 0.5);
}

TEST(PathCause, IsTheLargestLossWithoutWhichTheEchoSuffices) {
  EXPECT_EQ(causeOfDetection(radarBudget(20)), PathCause::covered);
  PathBudget budget = radarBudget(-10);
  EXPECT_EQ(causeOfDetection(budget), PathCause::noise) << "too weak in free space";
  budget.excess.loss_db = 12;
  EXPECT_EQ(causeOfDetection(budget), PathCause::terrain) << "12 dB there and back";
  budget.pointing.pattern_db = -20;
  EXPECT_EQ(causeOfDetection(budget), PathCause::pointing);
  budget.look_pattern_db = 0;
  EXPECT_EQ(causeOfDetection(budget), PathCause::terrain) << "the beam follows the target";
  budget.excess.clutter_db = 10;
  EXPECT_EQ(causeOfDetection(budget), PathCause::clutter) << "trees cost most of it";
  budget.excess.parts = {{"gases", "", 12}};
  budget.excess.clutter_db = 0;
  EXPECT_EQ(causeOfDetection(budget), PathCause::noise) << "air is on every path";
}

TEST(PathCause, IsJammingClutterRangeOrSilenceWhereTheyTakeTheDetectionAway) {
  PathBudget budget = radarBudget(20);
  budget.terms[2].value = 0.01;
  budget.jamming = {"jammer", 0, 0.9};
  budget.excess.loss_db = 100;
  EXPECT_EQ(causeOfDetection(budget), PathCause::jamming);
  EXPECT_EQ(decisionText(budget), "Jamming by 'jammer' decides.");
  budget.unheard = "beyond the radar's instrumented range of 5.0 km";
  EXPECT_EQ(causeOfDetection(budget), PathCause::range);
  budget.active = false;
  EXPECT_EQ(causeOfDetection(budget), PathCause::silent);
  budget = radarBudget(20);
  budget.terms[2].value = 0.01;
  budget.terms.push_back({"sclnr_db", "", -5, "dB", ""});
  EXPECT_EQ(causeOfDetection(budget), PathCause::clutter);
  EXPECT_EQ(decisionText(budget), "Clutter decides: its echoes hide the target.");
  budget.terms.push_back({"filter_response_db", "", -HUGE_VAL, "dB", ""});
  EXPECT_EQ(decisionText(budget),
            "The filter against clutter decides: it removes the echo of a target of this radial speed.");
}

TEST(PathCause, OfASignalCountsItsLossesOnce) {
  PathBudget budget;
  budget.terms = {{"received_power_dbm", "", -100, "dBm", ""}};
  budget.excess.loss_db = 12;
  EXPECT_EQ(causeOf(budget, Quantity::received_power_dbm, -110), PathCause::covered);
  EXPECT_EQ(causeOf(budget, Quantity::received_power_dbm, -90), PathCause::terrain);
  EXPECT_EQ(causeOf(budget, Quantity::received_power_dbm, -80), PathCause::noise);
}

TEST(PathCause, IsASentenceWithWhatItCostsAndWhatIsMissing) {
  PathBudget budget = radarBudget(-10);
  budget.excess.loss_db = 30;
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 60.0 dB stronger; 23.0 dB are missing.");
  budget.excess.loss_db = 5;
  EXPECT_THAT(decisionText(budget), HasSubstr("23.0 dB too weak, 13.0 dB even in free space"));
  EXPECT_EQ(decisionText(radarBudget(20)), "");
  EXPECT_EQ(decisionText(PathBudget{}), "") << "neither radar nor receiver";
}

}  // namespace
}  // namespace emscape::emfield
