/// Median of the last few measurements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace emscape::render {

/// Median of the last `window` values; a few outliers do not change it.
class RunningMedian {
 public:
  /// @param window  >= 1
  explicit RunningMedian(std::size_t window) : window_(window) {}

  void add(double value) {
    if (isFull()) values_.erase(values_.begin());
    values_.push_back(value);
  }
  void clear() { values_.clear(); }

  bool empty() const { return values_.empty(); }
  bool isFull() const { return values_.size() >= window_; }
  /// The upper of two middle values; 0 without values.
  double median() const {
    if (values_.empty()) return 0;
    std::vector<double> sorted = values_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  std::size_t window_;
  std::vector<double> values_;  // oldest first
};

}  // namespace emscape::render
