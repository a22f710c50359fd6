/// The mode `auto`: which pattern casts busy frames so that they come in time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emscape/render/pattern.h"
#include "emscape/render/running_median.h"

namespace emscape::render {

/// What one busy frame took. The sum of the times is the least time between two pictures.
struct FrameCost {
  double draw_ms = 0;    ///< casting and interpolating: what the choice of the pattern changes
  double other_ms = 0;   ///< the rest: the field's update, labels, showing
  double ray_share = 0;  ///< of all pixels, those that were cast; 0: as many as its pattern usually casts

  double total_ms() const { return draw_ms + other_ms; }
};

/// A pattern that may be chosen, and the part of the pixels that it usually casts.
struct QualityLevel {
  Pattern pattern = Pattern::full;
  double ray_share = 1;
};
/// The patterns to choose from, the most rays first.
const std::vector<QualityLevel>& qualityLevels();

/// Chooses the pattern with the most rays that meets a frame budget.
///
/// Down: at once after one frame that takes more than kClearMiss budgets, or two in a row above the budget,
/// to the first pattern that is expected to meet it. Up: when the last `patience` frames were within the
/// budget and their median, scaled by the shares of rays, promises at most kHeadroom of the budget. Patience
/// is kMinPatience frames; a pattern that does not hold for kHolds times as many frames doubles it, up to
/// kMaxPatience. Hence, for any times, at most 6 + n / 72 changes upwards in n frames.
///
/// With the pattern adaptive, the last one, the tolerance follows what the budget leaves for drawing.
class PatternChoice {
 public:
  static constexpr double kClearMiss = 1.5;
  static constexpr double kHeadroom = 0.85;
  static constexpr int kMinPatience = 8;
  static constexpr int kMaxPatience = 256;
  static constexpr int kHolds = 8;
  static constexpr int kWarmUpFrames = 1;         ///< these are not judged
  static constexpr double kAdaptiveTarget = 0.9;  ///< part of the budget that adaptive frames are to take

  /// @param budget_ms  > 0
  /// @param fixed      this pattern always; only its tolerance is chosen
  explicit PatternChoice(double budget_ms, std::optional<Pattern> fixed = {});

  Pattern pattern() const { return fixed_.value_or(level().pattern); }
  double tolerance_levels() const { return tolerance_levels_; }  ///< for the pattern adaptive
  /// Why, as a sentence without its full stop.
  const std::string& reason() const { return reason_; }

  /// Reports the times of a frame with pattern(). @return whether the pattern is another one now
  bool add(const FrameCost& cost);
  /// What was measured says nothing any more (another size, another mode): warms up again, keeps the pattern.
  void forget();

 private:
  const QualityLevel& level() const { return qualityLevels()[level_]; }
  double shareOf(const FrameCost& cost) const;
  double expected_ms(std::size_t level, double full_ms, double other_ms) const;
  void followBudget(const FrameCost& cost);
  bool goDown(const FrameCost& cost);
  bool goUp();
  void change(std::size_t level);

  double budget_ms_;
  std::optional<Pattern> fixed_;
  std::size_t level_ = 0;
  double tolerance_levels_ = kDefaultTolerance_levels;
  std::string reason_;
  RunningMedian full_ms_{kMinPatience};  // what a full frame would take to draw, by the share of rays
  RunningMedian other_ms_{kMinPatience};
  int warm_up_left_ = kWarmUpFrames;
  int misses_in_row_ = 0;
  int good_frames_ = 0;  // in a row
  int patience_ = kMinPatience;
  int frames_since_up_ = -1;  // -1: the pattern was not reached from below
};

}  // namespace emscape::render
