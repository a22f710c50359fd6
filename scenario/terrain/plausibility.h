/// Heights that cannot be right: not on earth, or of 16 bits in the other byte order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "scenario/terrain/fill_values.h"

namespace emscape::scenario {

class TerrainFile;

/// No ground or sea bed is beyond these heights (Challenger Deep -10,935 m, Mount Everest 8,849 m).
constexpr double kLowestOnEarth_m = -11500, kHighestOnEarth_m = 9000;

/// The number whose bytes are those of a number of 16 bits, or of a real number of 32 bits, exchanged.
float withSwappedBytes(float value);
float withSwappedBytesOfReal(float value);

/// What a file's heights look like, counted while they are read.
class HeightTally {
 public:
  /// Counts a height that the file does not declare as void. False if it is not on earth: it is void.
  bool add(double height_m) {
    ++posts_;
    if (height_m >= kLowestOnEarth_m && height_m <= kHighestOnEarth_m) return true;
    addBeyond(height_m);
    return false;
  }
  /// Compares the steps between neighbours of a row of 16 bits with those of swapped bytes.
  /// @param is_known  of each value; false: void
  void addSteps(const std::vector<float>& values, const std::vector<std::uint8_t>& is_known,
                std::size_t first, std::size_t count);
  void add(const HeightTally& other);
  /// Counts a real number that no height is, as the other byte order makes of heights: not 0, but nearly.
  void addReal(float value);
  /// True if numbers are not heights in metres or any other unit, but such of the other byte order.
  bool looksSwappedReal() const;

  /// True if the surface becomes smooth by exchanging the bytes of its heights.
  bool looksSwapped() const;

  struct Value {
    double height_m;
    long long posts;
  };
  /// The heights beyond, if they are so few that they are fill values; else empty.
  std::vector<Value> fills() const;
  long long posts() const { return posts_; }
  long long beyond() const { return beyond_; }
  double lowest_m() const { return lowest_m_; }
  double highest_m() const { return highest_m_; }

 private:
  static constexpr float kLeastReal = 1e-20F;
  void addBeyond(double height_m, long long posts = 1);

  long long posts_ = 0, beyond_ = 0;
  long long tiny_ = 0, tiny_heights_ = 0;  ///< nearly 0; those of them that are heights in the other order
  double lowest_m_ = std::numeric_limits<double>::infinity();
  double highest_m_ = -std::numeric_limits<double>::infinity();
  std::vector<Value> values_;  ///< beyond, different ones; at most one more than fill values
  long long pairs_ = 0, steps_ = 0;
  double step_sum_ = 0, swapped_step_sum_ = 0;
};

/// What is said of a file's heights.
struct Implausibility {
  bool is_error = false;  ///< the file cannot be used as it is
  std::string text;
};

/// @param fills  of the same heights
std::vector<Implausibility> implausibilitiesOf(const TerrainFile& file, const HeightTally& tally,
                                               const FillValues::Result& fills);

}  // namespace emscape::scenario
