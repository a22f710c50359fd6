// What decides that a point is not covered.
#include "emscape/emfield/link/path_cause.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emfield/link/path_decision.h"
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
  budget.terms.push_back({"jammer_to_signal_db", "", 30, "dB", ""});
  EXPECT_NE(causeOfDetection(budget), PathCause::range)
      << "jammed, it would not be detected without the limit";
  budget.terms.back().value = -20;
  EXPECT_EQ(causeOfDetection(budget), PathCause::range) << "the echo burns through";
  budget.terms[0].value = -60;
  budget.jamming.unjammed_probability = 0;
  EXPECT_EQ(causeOfDetection(budget), PathCause::terrain) << "nor would it be detected without the limit";
  budget.active = false;
  EXPECT_EQ(causeOfDetection(budget), PathCause::silent);
  budget = radarBudget(20);
  budget.terms[2].value = 0.01;
  budget.terms.push_back({"sclnr_db", "", -5, "dB", ""});
  EXPECT_EQ(causeOfDetection(budget), PathCause::clutter);
  EXPECT_EQ(decisionText(budget), "Clutter decides: echoes of land, sea or rain hide the target.");
  budget.terms.push_back({"filter_response_db", "", -HUGE_VAL, "dB", ""});
  EXPECT_EQ(decisionText(budget),
            "The filter against clutter decides: it removes the echo of a target of this radial speed.");
}

TEST(PathCause, IsToldWithTheJammingThatDecidesWithoutIt) {
  PathBudget budget = radarBudget(-50);
  budget.pointing.pattern_db = -45;
  budget.jamming = {"jammer", 0, 0};
  budget.terms.push_back({"jammer_to_signal_db", "", 9, "dB", ""});
  EXPECT_EQ(decisionText(budget),
            "Pointing decides: without it the echo is 90.0 dB stronger; 63.0 dB are missing. "
            "Jamming by 'jammer' decides then: J/S 9.0 dB.");
  budget.terms.back().value = -20;
  EXPECT_EQ(decisionText(budget),
            "Pointing decides: without it the echo is 90.0 dB stronger; 63.0 dB are missing.");
  budget.pointing.pattern_db = 0;
  budget.excess.loss_db = 40;
  budget.terms.back().value = 75;
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 80.0 dB stronger; 63.0 dB are missing. "
            "Jamming by 'jammer' decides then: J/S -5.0 dB.")
      << "J/S falls with the echo's loss, to less than the 13 dB that are needed";
  budget.terms.back().value = 40;
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 80.0 dB stronger; 63.0 dB are missing.");
}

TEST(PathCause, OfSeveralEmittersIsThatOfTheNearestToDetectingWhateverTheirOrder) {
  const auto decide = [](const PathBudget& budget) {
    return emfield::decide(budget, Quantity::detection_probability, 0.5);
  };
  PathBudget beyond_range = radarBudget(20), hopeless = radarBudget(-60), silent = radarBudget(20);
  beyond_range.terms[2].value = 0;
  beyond_range.unheard = "beyond the radar's instrumented range of 5.0 km";
  hopeless.excess.loss_db = 100;
  silent.active = false;
  const std::vector<Decision> nearest_first{decide(radarBudget(20)), decide(beyond_range),
                                            decide(radarBudget(-10)), decide(hopeless), decide(silent)};
  for (std::size_t i = 0; i < nearest_first.size(); ++i) {
    for (std::size_t k = 0; k < nearest_first.size(); ++k)
      EXPECT_EQ(nearest_first[i].isNearerThan(nearest_first[k]), i < k) << i << ", " << k;
  }
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
