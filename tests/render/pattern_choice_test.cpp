#include "render/patterns/pattern_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace emscape::render {
namespace {

using testing::HasSubstr;

double shareOf(Pattern pattern) {
  for (const QualityLevel& level : qualityLevels()) {
    if (level.pattern == pattern) return level.ray_share;
  }
  return 1;
}

/// A scene with a given time of a full frame; other work takes the same time in every frame.
FrameCost costOf(Pattern pattern, double full_ms, double other_ms = 0) {
  return {full_ms * shareOf(pattern), other_ms};
}

/// Plays frames; full_ms may depend on the frame's number. Returns how often the pattern changed.
struct Changes {
  int up = 0, down = 0;
};
Changes play(PatternChoice& choice, int frames, const std::function<double(int)>& full_ms,
             double other_ms = 0) {
  Changes changes;
  for (int n = 0; n < frames; ++n) {
    const double before = shareOf(choice.pattern());
    const bool changed = choice.add(costOf(choice.pattern(), full_ms(n), other_ms));
    const double after = shareOf(choice.pattern());
    EXPECT_EQ(changed, after != before);
    if (after > before) ++changes.up;
    if (after < before) ++changes.down;
  }
  return changes;
}
std::function<double(int)> always(double full_ms) {
  return [full_ms](int) { return full_ms; };
}

TEST(PatternChoice, LevelsHaveFewerAndFewerRays) {
  ASSERT_FALSE(qualityLevels().empty());
  EXPECT_EQ(qualityLevels().front().pattern, Pattern::full);
  for (std::size_t n = 1; n < qualityLevels().size(); ++n) {
    EXPECT_LT(qualityLevels()[n].ray_share, qualityLevels()[n - 1].ray_share);
  }
}

TEST(PatternChoice, CastsEveryPixelWhileWithinBudget) {
  PatternChoice choice(40);
  const Changes changes = play(choice, 200, always(39));
  EXPECT_EQ(changes.down + changes.up, 0);
  EXPECT_EQ(choice.pattern(), Pattern::full);
}

TEST(PatternChoice, TakesThePatternWithTheMostRaysThatIsInTime) {
  PatternChoice half(40);
  play(half, 40, always(70));
  EXPECT_EQ(half.pattern(), Pattern::columns);
  PatternChoice quarter(40);
  play(quarter, 40, always(120));
  EXPECT_EQ(quarter.pattern(), Pattern::quarter);
}

TEST(PatternChoice, GoesDownAtOnceAfterAClearMissPastPatternsThatWouldMissToo) {
  PatternChoice choice(40);
  play(choice, 10, always(30));
  EXPECT_TRUE(choice.add({120, 0}));
  EXPECT_EQ(choice.pattern(), Pattern::quarter);
  EXPECT_THAT(choice.reason(), HasSubstr("full took 120.0 ms of 40 ms; quarter is expected to take 30.0 ms"));
}

TEST(PatternChoice, GoesDownAfterTwoSlightMissesInARowButNotAfterOne) {
  PatternChoice choice(40);
  play(choice, 10, always(30));
  for (int n = 0; n < 5; ++n) {
    EXPECT_FALSE(choice.add({45, 0}));
    EXPECT_FALSE(choice.add({30, 0}));
  }
  EXPECT_FALSE(choice.add({45, 0}));
  EXPECT_TRUE(choice.add({45, 0}));
  EXPECT_EQ(choice.pattern(), Pattern::columns);
}

TEST(PatternChoice, GoesUpOnlyWhenClearlyInTimeAndAfterSeveralFrames) {
  PatternChoice choice(40);
  play(choice, 3, always(100));
  ASSERT_EQ(choice.pattern(), Pattern::quarter);
  // columns would take 36 ms: in time, but not clearly
  EXPECT_EQ(play(choice, 100, always(72)).up, 0);
  // columns would take 30 ms
  int frames = 1;
  while (!choice.add(costOf(Pattern::quarter, 60))) ++frames;
  EXPECT_EQ(choice.pattern(), Pattern::columns);
  EXPECT_LE(frames, PatternChoice::kMinPatience);
  EXPECT_THAT(choice.reason(), HasSubstr("columns is expected to take 30.0 ms"));
}

TEST(PatternChoice, WaitsSeveralFramesBeforeItGoesUpAgain) {
  PatternChoice choice(40);
  play(choice, 2, always(100));
  ASSERT_EQ(choice.pattern(), Pattern::quarter);
  for (int n = 1; n < PatternChoice::kMinPatience; ++n) EXPECT_FALSE(choice.add({2, 0})) << n;
  EXPECT_TRUE(choice.add({2, 0}));
  EXPECT_EQ(choice.pattern(), Pattern::full);  // 8 ms: past columns
}

TEST(PatternChoice, CountsTheFieldsUpdateWithinTheBudget) {
  PatternChoice choice(40);
  play(choice, 40, always(30), 20);  // 30 + 20 > 40 >= 15 + 20
  EXPECT_EQ(choice.pattern(), Pattern::columns);
  EXPECT_EQ(play(choice, 400, always(30), 20).up, 0);
}

TEST(PatternChoice, OccasionalFieldUpdateDoesNotLowerTheLevel) {
  PatternChoice choice(40);
  play(choice, 4, always(100));
  ASSERT_NE(choice.pattern(), Pattern::full);
  for (int n = 0; n < 30; ++n) choice.add({20 * shareOf(choice.pattern()), n % 12 == 0 ? 15.0 : 0.0});
  EXPECT_EQ(choice.pattern(), Pattern::full);
}

TEST(PatternChoice, ReportsThatNoPatternHasFewerRays) {
  PatternChoice choice(40);
  play(choice, 30, always(4000));
  EXPECT_EQ(choice.pattern(), qualityLevels().back().pattern);
  EXPECT_THAT(choice.reason(), HasSubstr("no pattern has fewer rays"));
}

TEST(PatternChoice, DoesNotJudgeTheFirstFrame) {
  PatternChoice choice(40);
  EXPECT_FALSE(choice.add({400, 0}));
  EXPECT_EQ(choice.pattern(), Pattern::full);
  play(choice, 4, always(100));
  const Pattern lower = choice.pattern();
  choice.forget();
  EXPECT_FALSE(choice.add({4000, 0}));
  EXPECT_EQ(choice.pattern(), lower);
}

/// Fewer rays with a larger tolerance, as on an EME volume.
double adaptiveShare(double tolerance_levels, double detail) {
  return std::clamp(detail / std::sqrt(tolerance_levels), 0.02, 0.6);
}

TEST(PatternChoice, TheToleranceOfAdaptiveFollowsTheBudget) {
  PatternChoice choice(40);
  for (const double full_ms : {300.0, 600.0, 300.0}) {
    for (int n = 0; n < 60; ++n) {
      const bool adaptive = choice.pattern() == Pattern::adaptive;
      const double share =
          adaptive ? adaptiveShare(choice.tolerance_levels(), 0.1) : shareOf(choice.pattern());
      choice.add({full_ms * share, 2, share});
    }
    ASSERT_EQ(choice.pattern(), Pattern::adaptive);
    const double draw_ms = full_ms * adaptiveShare(choice.tolerance_levels(), 0.1);
    EXPECT_NEAR(draw_ms + 2, PatternChoice::kAdaptiveTarget * 40, 1) << full_ms;
  }
}

TEST(PatternChoice, SaysWhyItIsAdaptive) {
  PatternChoice choice(40);
  for (int n = 0; n < 3; ++n) choice.add({300 * shareOf(choice.pattern()), 0});
  ASSERT_EQ(choice.pattern(), Pattern::adaptive);
  EXPECT_EQ(choice.reason(), "full took 300.0 ms of 40 ms; adaptive casts as many rays as there is time for");
}

TEST(PatternChoice, LeavesAdaptiveByTheRaysThatItCast) {
  PatternChoice choice(40);
  for (int n = 0; n < 20; ++n) choice.add({1000 * shareOf(choice.pattern()), 0});
  ASSERT_EQ(choice.pattern(), Pattern::adaptive);
  // 30 ms for 0.9 of the rays: columns would take 17 ms, full 33
  for (int n = 0; n < 20; ++n) {
    choice.add(choice.pattern() == Pattern::adaptive ? FrameCost{30, 0, 0.9}
                                                     : FrameCost{33 * shareOf(choice.pattern()), 0});
  }
  EXPECT_EQ(choice.pattern(), Pattern::full);
}

TEST(PatternChoice, AFixedPatternStaysButItsToleranceFollowsTheBudget) {
  PatternChoice columns(40, Pattern::columns);
  EXPECT_EQ(columns.reason(), "columns was requested");
  for (int n = 0; n < 20; ++n) EXPECT_FALSE(columns.add({900, 0}));
  EXPECT_EQ(columns.pattern(), Pattern::columns);
  PatternChoice adaptive(40, Pattern::adaptive);
  const double before = adaptive.tolerance_levels();
  for (int n = 0; n < 20; ++n) EXPECT_FALSE(adaptive.add({900, 0}));
  EXPECT_EQ(adaptive.pattern(), Pattern::adaptive);
  EXPECT_GT(adaptive.tolerance_levels(), before);
}

TEST(PatternChoice, OtherWorkThatTakesTheWholeBudgetLeavesAdaptiveATenth) {
  PatternChoice choice(40, Pattern::adaptive);
  double draw_ms = 0;
  for (int n = 0; n < 60; ++n) {
    draw_ms = 100 * adaptiveShare(choice.tolerance_levels(), 0.1);
    choice.add({draw_ms, 50, 0.1});
  }
  EXPECT_NEAR(draw_ms, 4, 0.5);
}

TEST(PatternChoice, ChangesNoMoreOftenThanStated) {
  std::mt19937 random(7);
  // A quarter or columns promise that the next pattern is in time, and then it is not: the ratio of the times
  // is not that of the rays. The worst of scenes, with noise of several strengths.
  for (const double noise : {0.0, 0.1, 0.3}) {
    for (const double penalty : {1.0, 1.3, 2.0}) {
      for (const double full_ms : {30.0, 45.0, 60.0, 75.0, 90.0, 130.0}) {
        PatternChoice choice(40);
        std::normal_distribution<double> deviation(1, noise);
        constexpr int kFrames = 5000;
        int up = 0;
        int down = 0;
        for (int n = 0; n < kFrames; ++n) {
          const double share = shareOf(choice.pattern());
          const double slower = share > 0.4 ? penalty : 1;
          choice.add({full_ms * share * slower * std::max(0.2, deviation(random)), 0});
          up += shareOf(choice.pattern()) > share ? 1 : 0;
          down += shareOf(choice.pattern()) < share ? 1 : 0;
        }
        EXPECT_LE(up, 6 + kFrames / 72) << noise << " " << penalty << " " << full_ms;
        EXPECT_LE(down, static_cast<int>(qualityLevels().size() - 1) * (up + 1));
        if (noise == 0) {
          EXPECT_LE(up, 6 + kFrames / PatternChoice::kMaxPatience) << full_ms;
        }
      }
    }
  }
}

TEST(PatternChoice, RareSlowFramesCostLittleTime) {
  PatternChoice choice(40);
  int full = 0;
  constexpr int kFrames = 5000;
  for (int n = 0; n < kFrames; ++n) {
    full += choice.pattern() == Pattern::full ? 1 : 0;
    choice.add({(n % 250 == 249 ? 90 : 25) * shareOf(choice.pattern()), 0});
  }
  EXPECT_GT(full, kFrames * 9 / 10);
}

}  // namespace
}  // namespace emscape::render
