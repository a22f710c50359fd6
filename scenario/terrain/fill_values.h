/// Fill values that an elevation file does not declare as no data, found by their shape.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace emscape::scenario {

/// A height is a fill value if it is below -500 m (no land is: the Dead Sea's shore is at -440 m), and if at
/// each post that has it every neighbour either has it, too, or is more than 500 m above. Depths of the sea
/// do not look so: their neighbours are near.
class FillValues {
 public:
  static constexpr float kBelow_m = -500, kStep_m = 500;

  /// @param unit_m  of the file's heights (m), for its usual fill values
  explicit FillValues(long long columns, double unit_m = 1);

  /// Adds the next row of posts (m; NaN: void), one after another.
  void add(const float* heights_m);

  struct Found {
    float height_m = 0;
    long long posts = 0;
  };
  struct Result {
    std::vector<Found> fills;  ///< the lowest first
    /// Of the heights below kBelow_m that are no fill values; lowest > highest: there are none.
    float lowest_m = std::numeric_limits<float>::infinity();
    float highest_m = -std::numeric_limits<float>::infinity();
    long long low_posts = 0;  ///< of these heights
    /// There are so many different heights below kBelow_m that only the usual fill values (-9999, ...) were
    /// searched for.
    bool is_partial = false;
  };
  /// To be called once, after the last row.
  Result result();

 private:
  /// Rows around the middle one; null: there is none.
  void judge(const float* below_m, const float* middle_m, const float* above_m);
  bool isUsual(float height_m) const { return usual_m_.count(height_m) != 0; }
  void addToRange(float height_m, long long posts = 1);

  /// Heights that were seen beside near ones, as bits: a height has two, which others may have, too.
  struct Bits {
    std::uint32_t first, second;
  };
  static Bits bitsOf(float height_m);
  bool hasBit(std::uint32_t bit) const { return (connected_[bit / 64] >> bit % 64 & 1U) != 0; }
  void setBit(std::uint32_t bit);

  std::size_t columns_;
  std::vector<float> before_m_, last_m_;  ///< the last two rows
  bool has_before_ = false, has_last_ = false;
  std::set<float> usual_m_, usual_connected_m_;
  std::map<float, long long> isolated_;  ///< posts of each height of which one is isolated
  std::vector<std::uint64_t> connected_;
  std::size_t bits_ = 0;  ///< that are set
  Result result_;
};

}  // namespace emscape::scenario
