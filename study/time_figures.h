/// Figures of coverage over time, place by place.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "emscape/study/coverage.h"

namespace emscape::study {

/// A time stands for the interval up to the next one; the last for none. Gaps at the beginning and at the end
/// count.
class TimeFigures {
 public:
  /// @param places   0: nothing is kept
  /// @param times_s  rising
  TimeFigures(std::size_t places, std::vector<double> times_s);

  /// Adds the next of the times.
  void add(double time_s, const std::function<bool(std::size_t place)>& isCovered);

  /// first_detection (NaN: never), fraction, longest_gap or mean_gap (0: no gap), after the last time.
  float figure(Product product, std::size_t place) const;

 private:
  struct Place {
    float first_s;        ///< NaN: not yet
    float covered_s = 0;  ///< time so far
    float gap_s = 0;      ///< of the gap that goes on
    float longest_gap_s = 0, all_gaps_s = 0;
    std::uint32_t gaps = 0;
  };
  std::vector<double> times_s_;
  std::size_t next_ = 0;
  std::vector<Place> places_;
};

}  // namespace emscape::study
