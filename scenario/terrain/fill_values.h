/// Fill values that an elevation file does not declare as no data, found by their shape.
#pragma once

#include <map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace emscape::scenario {

/// A height is a fill value if it is below -500 m (no land is: the Dead Sea's shore is at -440 m), and if at
/// each post that has it every neighbour either has it, too, or is more than 500 m above. Depths of the sea
/// do not look so: their neighbours are near.
class FillValues {
 public:
  static constexpr float kBelow_m = -500, kStep_m = 500;

  explicit FillValues(long long columns) : columns_(static_cast<std::size_t>(columns)) {}

  /// Adds the next row of posts (m; NaN: void), one after another.
  void add(const float* heights_m);

  struct Found {
    float height_m = 0;
    long long posts = 0;
  };
  /// The values found, the lowest first. To be called once, after the last row.
  std::vector<Found> found();

 private:
  /// Rows around the middle one; null: there is none.
  void judge(const float* below_m, const float* middle_m, const float* above_m);

  /// More heights than these are no fill values.
  static constexpr std::size_t kMaxHeights = 65536;

  std::size_t columns_;
  std::vector<float> before_m_, last_m_;  ///< the last two rows; empty if neither has low heights
  bool has_before_ = false, has_last_ = false;
  std::map<float, long long> isolated_;
  std::unordered_set<float> connected_;
};

}  // namespace emscape::scenario
