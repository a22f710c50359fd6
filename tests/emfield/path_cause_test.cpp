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
  budget.profile.has_terrain = true;
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
  budget.jamming = {{{"jammer", 30, 0}}, 0.9, {}, 0, {}};
  budget.excess.loss_db = 100;
  EXPECT_EQ(causeOfDetection(budget), PathCause::jamming);
  EXPECT_EQ(decisionText(budget), "Jamming by 'jammer' decides.");
  budget.unheard = "beyond the radar's instrumented range of 5.0 km";
  budget.probability_in_any_range = 0.3;
  budget.jamming.unjammed_probability = 0;
  budget.jamming.unjammed_in_any_range = 0.9;
  EXPECT_EQ(causeOfDetection(budget), PathCause::range) << "both are to go";
  EXPECT_EQ(decisionText(budget), "The radar's range limit decides. Jamming by 'jammer' decides then.");
  budget.probability_in_any_range = 0.6;
  EXPECT_EQ(causeOfDetection(budget), PathCause::range) << "the echo burns through";
  EXPECT_EQ(decisionText(budget), "The radar's range limit decides.");
  budget.probability_in_any_range = 0;
  budget.terms[0].value = -60;
  budget.jamming.unjammed_in_any_range = 0;
  EXPECT_EQ(causeOfDetection(budget), PathCause::terrain) << "nor would it be detected without the limit";
  EXPECT_THAT(decisionText(budget), HasSubstr("dB are missing. The radar's range limit decides then."));
  budget.active = false;
  EXPECT_EQ(causeOfDetection(budget), PathCause::silent);
  budget = radarBudget(20);
  budget.terms[2].value = 0.01;
  budget.terms.push_back({"sclnr_db", "", -5, "dB", ""});
  EXPECT_EQ(causeOfDetection(budget), PathCause::clutter);
  EXPECT_EQ(decisionText(budget), "Clutter decides: echoes of land, sea or rain hide the target.");
  budget.jamming = {{{"jammer", -3, 0}}, 0.1, PathJamming::WithoutClutterAnd{0.2, 0, 0, 0}, 0, {}};
  EXPECT_EQ(decisionText(budget),
            "Clutter decides: echoes of land, sea or rain hide the target. Jamming by 'jammer' decides then: "
            "J/S -3.0 dB.");
  budget.terms.push_back({"filter_response_db", "", -HUGE_VAL, "dB", ""});
  EXPECT_EQ(decisionText(budget),
            "The filter against clutter decides: it removes the echo of a target of this radial speed.");
}

TEST(PathCause, IsToldWithTheJammingThatDecidesWithoutIt) {
  PathBudget budget = radarBudget(-50);
  budget.pointing.pattern_db = -45;
  budget.jamming = {{{"jammer", 9, 0}}, 0, PathJamming::WithoutClutterAnd{0, 0, 0, 0.2}, 0, {}};
  EXPECT_EQ(decisionText(budget),
            "Pointing decides: without it the echo is 90.0 dB stronger; 63.0 dB are missing. "
            "Jamming by 'jammer' decides then: J/S 9.0 dB.");
  budget.jamming.without_clutter->pointing = 0.9;
  EXPECT_EQ(decisionText(budget),
            "Pointing decides: without it the echo is 90.0 dB stronger; 63.0 dB are missing.");
  budget.pointing.pattern_db = 0;
  budget.excess.loss_db = 40;
  budget.jamming.jammers[0].to_signal_db = 75;
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 80.0 dB stronger; 63.0 dB are missing. "
            "Jamming by 'jammer' decides then: J/S -5.0 dB.")
      << "J/S falls with the echo's loss, to less than the 13 dB that are needed";
  budget.terms.push_back({"filter_response_db", "", -20, "dB", ""});
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 80.0 dB stronger; 63.0 dB are missing.")
      << "nor would it be detected without jamming";
  budget.terms.pop_back();
  budget.jamming.without_clutter->terrain = 0.9;
  EXPECT_EQ(decisionText(budget),
            "Terrain decides: without it the echo is 80.0 dB stronger; 63.0 dB are missing.");
}

TEST(PathCause, NamesTheJammerWithoutWhichTheOthersLeaveTheMostDetection) {
  PathBudget budget = radarBudget(20);
  budget.terms[2].value = 0.01;
  budget.jamming = {{{"blanked", 30, 0.99, 0.02}, {"in the beam", 10, 0, 0.8}}, 0.9, {}, 0, {}};
  EXPECT_EQ(decisionText(budget), "Jamming by 'in the beam' decides.");
  budget.jamming.jammers[1].probability_without = 0.4;
  EXPECT_EQ(decisionText(budget),
            "Jamming by 'in the beam' decides; the other jammer prevents detection without it as well.");
  budget.jamming.jammers.push_back({"third", 5, 0, 0.1});
  EXPECT_EQ(decisionText(budget),
            "Jamming by 'in the beam' decides; the 2 other jammers prevent detection without it as well.");
}

TEST(PathCause, CountsClutterAsDetectionDoes) {
  PathBudget budget = radarBudget(20);
  budget.terms[2].value = 0.3;
  budget.terms.push_back({"sclnr_db", "", 14, "dB", ""});
  budget.terms.push_back({"clutter_correlation_loss_db", "", 6, "dB", ""});
  const Decision decision = decide(budget, Quantity::detection_probability, 0.5);
  EXPECT_EQ(decision.cause, PathCause::clutter);
  // 10^-1.4 - 10^-2 of clutter counts 10^0.6 times: -10 lg(0.01 + 3.981 x 0.02981) = 8.905 dB.
  EXPECT_NEAR(decision.missing_db, 13 - 8.905, 0.001);
}

TEST(PathCause, TellsWhatIsMissingWithTheNoiseOfTheJammers) {
  PathBudget budget = radarBudget(4.1);
  budget.terms[2].value = 0;
  budget.jamming = {{{"jammer", 59.7, 0}}, 0, {}, 0, 72.7};
  EXPECT_EQ(decisionText(budget),
            "Noise decides: the echo is 8.9 dB too weak, 8.9 dB even in free space on the beam's axis. With "
            "jamming 72.7 dB are missing.");
  budget.jamming.missing_db = 8.92;
  EXPECT_THAT(decisionText(budget), testing::Not(testing::HasSubstr("jamming"))) << "weaker than the noise";
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
  PathObstacle far_below;
  far_below.clearance_m = 50;
  far_below.fresnel_radius_m = 10;
  far_below.decides = true;
  budget.obstacles = {far_below};
  budget.model = propagation::PropagationModel::parabolic_equation;
  EXPECT_THAT(decisionText(budget), HasSubstr("The loss by 'parabolic_equation' decides: ")) << "a null";
  budget.obstacles[0].clearance_m = -50;
  EXPECT_THAT(decisionText(budget), HasSubstr("Terrain decides: "));
  budget.model = propagation::PropagationModel::two_ray;
  EXPECT_THAT(decisionText(budget), HasSubstr("The loss by 'two_ray' decides: ")) << "it has no terrain";
  budget.model = propagation::PropagationModel::diffraction;
  budget.profile.has_terrain = false;
  EXPECT_THAT(decisionText(budget), HasSubstr("The loss by 'diffraction' decides: ")) << "the earth's bulge";
  budget.excess.loss_db = 5;
  EXPECT_THAT(decisionText(budget), HasSubstr("23.0 dB too weak, 13.0 dB even in free space"));
  EXPECT_EQ(decisionText(radarBudget(20)), "");
  EXPECT_EQ(decisionText(PathBudget{}), "") << "neither radar nor receiver";
}

}  // namespace
}  // namespace emscape::emfield
