#include "scenario/scan/scan_sampling.h"

#include <gtest/gtest.h>

namespace emscape::scenario {
namespace {

ScanSpec rotating(double rate_rpm) {
  ScanSpec scan;
  scan.kind = ScanKind::rotate;
  scan.rate_rpm = rate_rpm;
  return scan;
}

Clock clockOf(double duration_s, double step_s) {
  return {"", duration_s, step_s};
}

TEST(ScanSampling, StepsThatDivideATurnRepeatTheSameAzimuths) {
  // 15 degrees a step, 24 steps a turn: 24 spokes of 3 degrees.
  const ScanSampling sampling = *scanSampling(rotating(5), 3, clockOf(120, 0.5));
  EXPECT_DOUBLE_EQ(sampling.step_deg, 15);
  EXPECT_NEAR(sampling.lit_share, 24 * 3 / 360.0, 1e-9);
  EXPECT_TRUE(leavesGaps(sampling, 3));
}

TEST(ScanSampling, OfStepsThatDriftLightsAllAzimuthsInTime) {
  const ScanSampling whole = *scanSampling(rotating(5.02), 3, clockOf(120, 0.5));
  EXPECT_DOUBLE_EQ(whole.lit_share, 1);
  EXPECT_FALSE(leavesGaps(whole, 3));
  EXPECT_NEAR(scanSampling(rotating(5.02), 3, clockOf(5, 0.5))->lit_share, 11 * 3 / 360.0, 1e-9);
}

TEST(ScanSampling, OfSmallStepsLeavesNoGaps) {
  // Three quarters of a turn.
  const ScanSampling sampling = *scanSampling(rotating(-15), 8, clockOf(3, 0.01));
  EXPECT_NEAR(sampling.lit_share, 0.75 + 8 / 360.0, 1e-9);
  EXPECT_FALSE(leavesGaps(sampling, 8)) << "the rest of the turn is beyond the end, not between steps";
}

TEST(ScanSampling, OfASectorCountsWithinItsWidth) {
  ScanSpec scan;
  scan.kind = ScanKind::sector;
  scan.azimuth_deg = 300;
  scan.width_deg = 70;
  scan.rate_deg_s = 15;
  // Back and forth at multiples of 2.5 degrees, 29 of them; half a beam at each end.
  const ScanSampling sampling = *scanSampling(scan, 2, clockOf(120, 0.5));
  EXPECT_DOUBLE_EQ(sampling.step_deg, 7.5);
  EXPECT_NEAR(sampling.lit_share, 28 * 2 / 70.0, 1e-9);
}

TEST(ScanSampling, AppliesOnlyToSweepingBeamsInSeries) {
  EXPECT_FALSE(scanSampling(ScanSpec{}, 3, clockOf(120, 0.5)));
  EXPECT_FALSE(scanSampling(rotating(5), 3, clockOf(0, 0.5)));
  EXPECT_DOUBLE_EQ(scanSampling(rotating(5), 360, clockOf(120, 0.5))->lit_share, 1);
}

TEST(MissedActivity, OfBlinkingBetweenTheTimesIsToldWithTheStepThatMeetsIt) {
  Scenario scenario;
  scenario.platforms.emplace_back();
  scenario.platforms[0].track.emplace_back();
  Emitter emitter;
  emitter.name = "jammer";
  emitter.platform = 0;
  for (int n = 0; n < 20; ++n) emitter.active_s.push_back({4.0 * n, 4.0 * n + 1});
  scenario.emitters = {emitter};
  const auto text = [&](double begin_s, double step_s, double end_s = 60) {
    return missedActivityText(scenario, timesOf(begin_s, end_s, step_s));
  };
  EXPECT_EQ(text(0, 1), "");
  EXPECT_EQ(text(0, 0.5), "");
  EXPECT_EQ(text(0, 100), "") << "one time";
  EXPECT_EQ(text(0, 4),
            "emitter 'jammer' switches on and off between the times: from 0 to 60 s it radiates 25 % of the "
            "time, and at 100 % of the 16 times; steps of 1 s or less meet each of its pauses");
  EXPECT_NE(text(2, 4).find("and at 0 % of the 15 times; steps of 1 s or less meet each of its active times"),
            std::string::npos);
  EXPECT_EQ(text(0, 1.7, 78), "") << "many, met in the right share";
  scenario.emitters[0].active_s = {{9.5, 10}};
  EXPECT_NE(text(0, 4, 16).find("steps of 0.5 s or less meet each of its active times"), std::string::npos);
  scenario.emitters.push_back(scenario.emitters[0]);
  scenario.emitters[1].name = "other";
  EXPECT_NE(text(0, 4, 16).find("; likewise 'other'"), std::string::npos);
  scenario.emitters[0].enabled = scenario.emitters[1].enabled = false;
  EXPECT_EQ(text(0, 4, 16), "");
}

}  // namespace
}  // namespace emscape::scenario
