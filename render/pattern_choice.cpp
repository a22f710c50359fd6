#include "render/pattern_choice.h"

#include <fmt/format.h>

#include <algorithm>

namespace emscape::render {

const std::vector<Rung>& patternLadder() {
  static const std::vector<Rung> ladder{
      {Pattern::full, 1.0}, {Pattern::columns, 0.5}, {Pattern::quarter, 0.25}};
  return ladder;
}

PatternChoice::PatternChoice(double budget_ms)
    : budget_ms_(budget_ms),
      reason_(fmt::format("{} until frames are measured against the budget of {:.3g} ms", toString(pattern()),
                          budget_ms)) {}

bool PatternChoice::add(const FrameCost& cost) {
  if (warm_up_left_ > 0) {
    --warm_up_left_;
    return false;
  }
  draw_ms_.add(cost.draw_ms);
  other_ms_.add(cost.other_ms);
  if (frames_since_up_ >= 0) ++frames_since_up_;
  const bool is_miss = cost.total_ms() > budget_ms_;
  misses_in_row_ = is_miss ? misses_in_row_ + 1 : 0;
  good_frames_ = is_miss ? 0 : good_frames_ + 1;
  if (misses_in_row_ >= 2 || cost.total_ms() > kClearMiss * budget_ms_) return goDown(cost);
  return good_frames_ >= patience_ && goUp();
}

void PatternChoice::forget() {
  draw_ms_.clear();
  other_ms_.clear();
  warm_up_left_ = kWarmUpFrames;
  misses_in_row_ = 0;
  good_frames_ = 0;
  patience_ = kLeastPatience;
  frames_since_up_ = -1;
}

double PatternChoice::expected_ms(std::size_t rung_index, const FrameCost& cost) const {
  return cost.other_ms + cost.draw_ms * patternLadder()[rung_index].ray_share / rung().ray_share;
}

bool PatternChoice::goDown(const FrameCost& cost) {
  const std::size_t last = patternLadder().size() - 1;
  if (rung_ == last) {
    reason_ = fmt::format("a frame takes {:.1f} ms of {:.3g} ms, and no pattern has fewer rays than {}",
                          cost.total_ms(), budget_ms_, toString(pattern()));
    return false;
  }
  std::size_t lower = rung_ + 1;
  while (lower < last && expected_ms(lower, cost) > budget_ms_) ++lower;
  reason_ = fmt::format("{} took {:.1f} ms of {:.3g} ms; {} is expected to take {:.1f} ms",
                        toString(pattern()), cost.total_ms(), budget_ms_,
                        toString(patternLadder()[lower].pattern), expected_ms(lower, cost));
  if (frames_since_up_ >= 0) {
    const bool held = frames_since_up_ >= kHolds * patience_;
    patience_ = held ? kLeastPatience : std::min(2 * patience_, kMostPatience);
  }
  change(lower);
  frames_since_up_ = -1;
  return true;
}

bool PatternChoice::goUp() {
  const FrameCost usual{draw_ms_.median(), other_ms_.median()};
  std::size_t higher = 0;
  while (higher < rung_ && expected_ms(higher, usual) > kHeadroom * budget_ms_) ++higher;
  if (higher == rung_) return false;
  reason_ = fmt::format("{} takes {:.1f} ms of {:.3g} ms; {} is expected to take {:.1f} ms",
                        toString(pattern()), usual.total_ms(), budget_ms_,
                        toString(patternLadder()[higher].pattern), expected_ms(higher, usual));
  change(higher);
  frames_since_up_ = 0;
  return true;
}

void PatternChoice::change(std::size_t rung_index) {
  rung_ = rung_index;
  draw_ms_.clear();
  other_ms_.clear();
  misses_in_row_ = 0;
  good_frames_ = 0;
}

}  // namespace emscape::render
