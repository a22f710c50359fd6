#include "render/patterns/pattern_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/patterns/adaptive_tolerance.h"

namespace emscape::render {

const std::vector<QualityLevel>& qualityLevels() {
  static const std::vector<QualityLevel> levels{
      {Pattern::full, 1.0}, {Pattern::columns, 0.5}, {Pattern::quarter, 0.25}, {Pattern::adaptive, 0.1}};
  return levels;
}

PatternChoice::PatternChoice(double budget_ms, std::optional<Pattern> fixed)
    : budget_ms_(budget_ms),
      fixed_(fixed),
      reason_(fixed ? fmt::format("{} was requested", toString(*fixed))
                    : fmt::format("{} until frames are measured against the budget of {:.3g} ms",
                                  toString(pattern()), budget_ms)) {}

bool PatternChoice::add(const FrameCost& cost) {
  if (warm_up_left_ > 0) {
    --warm_up_left_;
    return false;
  }
  other_ms_.add(cost.other_ms);
  if (pattern() == Pattern::adaptive) followBudget(cost);
  if (fixed_) return false;
  full_ms_.add(cost.draw_ms / shareOf(cost));
  if (frames_since_up_ >= 0) ++frames_since_up_;
  const bool is_miss = cost.total_ms() > budget_ms_;
  misses_in_row_ = is_miss ? misses_in_row_ + 1 : 0;
  good_frames_ = is_miss ? 0 : good_frames_ + 1;
  if (misses_in_row_ >= 2 || cost.total_ms() > kClearMiss * budget_ms_) return goDown(cost);
  return good_frames_ >= patience_ && goUp();
}

void PatternChoice::forget() {
  full_ms_.clear();
  other_ms_.clear();
  warm_up_left_ = kWarmUpFrames;
  misses_in_row_ = 0;
  good_frames_ = 0;
  patience_ = kMinPatience;
  frames_since_up_ = -1;
}

double PatternChoice::shareOf(const FrameCost& cost) const {
  return cost.ray_share > 0 ? cost.ray_share : level().ray_share;
}

double PatternChoice::expected_ms(std::size_t level, double full_ms, double other_ms) const {
  return other_ms + full_ms * qualityLevels()[level].ray_share;
}

void PatternChoice::followBudget(const FrameCost& cost) {
  constexpr double kMinPart = 0.1;  // if the rest of the frame takes all of it
  const double left_ms = std::max(kAdaptiveTarget * budget_ms_ - other_ms_.median(), kMinPart * budget_ms_);
  tolerance_levels_ = nextTolerance_levels(tolerance_levels_, cost.draw_ms, left_ms);
}

bool PatternChoice::goDown(const FrameCost& cost) {
  const std::size_t last = qualityLevels().size() - 1;
  if (level_ == last) {
    reason_ = fmt::format("a frame takes {:.1f} ms of {:.3g} ms, and no pattern has fewer rays than {}",
                          cost.total_ms(), budget_ms_, toString(pattern()));
    return false;
  }
  const double full_ms = cost.draw_ms / shareOf(cost);
  std::size_t lower = level_ + 1;
  while (lower < last && expected_ms(lower, full_ms, cost.other_ms) > budget_ms_) ++lower;
  const Pattern chosen = qualityLevels()[lower].pattern;
  reason_ = fmt::format(
      "{} took {:.1f} ms of {:.3g} ms; {}", toString(pattern()), cost.total_ms(), budget_ms_,
      chosen == Pattern::adaptive ? "adaptive casts as many rays as there is time for"
                                  : fmt::format("{} is expected to take {:.1f} ms", toString(chosen),
                                                expected_ms(lower, full_ms, cost.other_ms)));
  if (frames_since_up_ >= 0) {
    const bool held = frames_since_up_ >= kHolds * patience_;
    patience_ = held ? kMinPatience : std::min(2 * patience_, kMaxPatience);
  }
  change(lower);
  frames_since_up_ = -1;
  return true;
}

bool PatternChoice::goUp() {
  const double full_ms = full_ms_.median();
  const double other_ms = other_ms_.median();
  std::size_t higher = 0;
  while (higher < level_ && expected_ms(higher, full_ms, other_ms) > kHeadroom * budget_ms_) ++higher;
  if (higher == level_) return false;
  reason_ = fmt::format("{} leaves enough of {:.3g} ms; {} is expected to take {:.1f} ms",
                        toString(pattern()), budget_ms_, toString(qualityLevels()[higher].pattern),
                        expected_ms(higher, full_ms, other_ms));
  change(higher);
  frames_since_up_ = 0;
  return true;
}

void PatternChoice::change(std::size_t index) {
  level_ = index;
  full_ms_.clear();
  other_ms_.clear();
  misses_in_row_ = 0;
  good_frames_ = 0;
  tolerance_levels_ = kDefaultTolerance_levels;
}

}  // namespace emscape::render
