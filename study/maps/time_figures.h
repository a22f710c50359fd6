/// Figures of coverage over time, at each position.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "emscape/study/maps/coverage.h"

namespace emscape::study {

/// A time represents the interval up to the next one; the last time represents none. Gaps at the beginning
/// and at the end count. A coverage begins at the first time if the position is covered then; a coverage or
/// gap at the last time ends there.
class TimeFigures {
 public:
  enum class Coverage { no, yes, unknown };

  /// @param places   0: nothing is computed
  /// @param times_s  ascending
  TimeFigures(std::size_t positions, std::vector<double> times_s);

  /// Adds the next of the times.
  void add(double time_s, const std::function<Coverage(std::size_t pixel)>& coverageOf);

  /// A product over time, after the last of the times; unknown times are as without coverage. NaN:
  /// first_detection of a position that is never covered, revisit of a position that is covered less than
  /// twice.
  float figure(Product product, std::size_t pixel) const;

  /// What a figure says: that of a position with unknown times is a bound for products that these can only
  /// change in one direction, if the position is covered at another time; else it is unknown.
  PixelAnswer answer(Product product, std::size_t pixel) const;

 private:
  struct Pixel {
    float first_s;        ///< since the first of the times, as all; NaN: not yet
    float covered_s = 0;  ///< time so far
    float gap_s = 0;      ///< of the present gap
    float longest_gap_s = 0, all_gaps_s = 0;
    float gaps_squared_s2 = 0;  ///< sum of the squares of the gaps
    float last_begin_s = 0;     ///< of the latest coverage
    std::uint32_t gaps = 0;
    std::uint32_t coverages = 0;
    bool is_covered = false;   ///< at the previous time
    bool has_unknown = false;  ///< at any time
  };
  std::vector<double> times_s_;
  std::size_t next_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace emscape::study
