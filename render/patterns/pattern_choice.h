/// The mode `auto`: chooses the pattern of busy frames that meets the frame budget.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emscape/render/scene/frame.h"
#include "render/patterns/running_median.h"

namespace emscape::render {

/// Cost of one busy frame. The sum of the times is the minimum time between two pictures.
struct FrameCost {
  double draw_ms = 0;    ///< casting and interpolation, which depend on the pattern
  double other_ms = 0;   ///< the rest: update of the field, labels, display
  double ray_share = 0;  ///< fraction of all pixels that were cast; 0: the usual fraction of its pattern

  double total_ms() const { return draw_ms + other_ms; }
};

/// A pattern that may be chosen, and the fraction of the pixels that it usually casts.
struct QualityLevel {
  Pattern pattern = Pattern::full;
  double ray_share = 1;
};
/// The patterns to choose from, by falling number of rays.
const std::vector<QualityLevel>& qualityLevels();

/// Chooses the pattern with the most rays that meets a frame budget.
///
/// Fewer rays: after one frame that takes more than kClearMiss budgets, or two consecutive frames above the
/// budget, it changes to the first pattern that is expected to meet the budget. More rays: when the last
/// `patience` frames were within the budget and their median, scaled by the fractions of rays, predicts at
/// most kHeadroom of the budget. `patience` is kMinPatience frames; a pattern that is left within kHolds
/// times as many frames doubles it, up to kMaxPatience. Hence there are at most 6 + n / 72 changes to more
/// rays in n frames, whatever the times.
///
/// With the last pattern, adaptive, the tolerance follows the part of the budget that is left for drawing.
class PatternChoice {
 public:
  static constexpr double kClearMiss = 1.5;
  static constexpr double kHeadroom = 0.85;
  static constexpr int kMinPatience = 8;
  static constexpr int kMaxPatience = 256;
  static constexpr int kHolds = 8;
  static constexpr int kWarmUpFrames = 1;         ///< frames that are not judged
  static constexpr double kAdaptiveTarget = 0.9;  ///< fraction of the budget that adaptive frames aim for

  /// @param budget_ms  > 0
  /// @param fixed      always this pattern; only its tolerance is chosen
  explicit PatternChoice(double budget_ms, std::optional<Pattern> fixed = {});

  Pattern pattern() const { return fixed_.value_or(level().pattern); }
  double tolerance_levels() const { return tolerance_levels_; }  ///< for the pattern adaptive
  /// Reason for the pattern, as a sentence without its full stop.
  const std::string& reason() const { return reason_; }

  /// Reports the cost of a frame with pattern(). @return true if the pattern has changed
  bool add(const FrameCost& cost);
  /// Discards the measurements after a change of size or mode: warms up again and keeps the pattern.
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
  RunningMedian full_ms_{kMinPatience};  // estimated drawing time of a full frame, by the fraction of rays
  RunningMedian other_ms_{kMinPatience};
  int warm_up_left_ = kWarmUpFrames;
  int misses_in_row_ = 0;
  int good_frames_ = 0;  // in a row
  int patience_ = kMinPatience;
  int frames_since_up_ = -1;  // -1: the pattern was not reached from below
};

}  // namespace emscape::render
