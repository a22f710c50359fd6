#include "scenario/terrain/fill_values.h"

#include <algorithm>

namespace emscape::scenario {

void FillValues::add(const float* heights_m) {
  if (has_last_) judge(has_before_ ? before_m_.data() : nullptr, last_m_.data(), heights_m);
  std::swap(before_m_, last_m_);
  has_before_ = has_last_;
  last_m_.assign(heights_m, heights_m + columns_);
  has_last_ = true;
}

std::vector<FillValues::Found> FillValues::found() {
  if (has_last_) judge(has_before_ ? before_m_.data() : nullptr, last_m_.data(), nullptr);
  has_last_ = false;
  std::vector<Found> found;
  if (connected_.size() >= kMaxHeights) return found;
  for (const auto& [height_m, posts] : isolated_) {
    if (connected_.count(height_m) == 0) found.push_back({height_m, posts});
  }
  return found;
}

void FillValues::judge(const float* below_m, const float* middle_m, const float* above_m) {
  for (std::size_t i = 0; i < columns_; ++i) {
    const float height_m = middle_m[i];
    if (!(height_m < kBelow_m) || connected_.size() >= kMaxHeights || connected_.count(height_m) > 0)
      continue;
    const std::size_t first = i > 0 ? i - 1 : 0, last = std::min(i + 1, columns_ - 1);
    bool is_isolated = true;
    for (const float* row : {below_m, middle_m, above_m}) {
      for (std::size_t k = first; row != nullptr && k <= last; ++k)
        is_isolated = is_isolated && !(row[k] != height_m && row[k] <= height_m + kStep_m);
    }
    if (is_isolated) {
      ++isolated_[height_m];
    } else {
      connected_.insert(height_m);
    }
  }
}

}  // namespace emscape::scenario
