#include "study/maps/time_figures.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::study {

TimeFigures::TimeFigures(std::size_t places, std::vector<double> times_s) : times_s_(std::move(times_s)) {
  Place none;
  none.first_s = NAN;
  places_.assign(places, none);
}

void TimeFigures::add(double time_s, const std::function<bool(std::size_t)>& isCovered) {
  const std::size_t at = next_++;
  const auto since_first_s = static_cast<float>(time_s - times_s_.front());
  const auto length_s = static_cast<float>(at + 1 < times_s_.size() ? times_s_[at + 1] - times_s_[at] : 0);
  parallelFor(static_cast<int>(places_.size()), 1 << 14, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      Place& place = places_[p];
      const bool was_covered = place.is_covered;
      place.is_covered = isCovered(static_cast<std::size_t>(p));
      if (place.is_covered) {
        if (std::isnan(place.first_s)) place.first_s = since_first_s;
        if (!was_covered) {
          ++place.coverages;
          place.last_begin_s = since_first_s;
        }
        place.covered_s += length_s;
        place.gap_s = 0;
      } else if (length_s > 0) {
        if (place.gap_s == 0) ++place.gaps;
        place.gaps_squared_s2 += length_s * (2 * place.gap_s + length_s);
        place.gap_s += length_s;
        place.all_gaps_s += length_s;
        place.longest_gap_s = std::max(place.longest_gap_s, place.gap_s);
      }
    }
  });
}

float TimeFigures::figure(Product product, std::size_t p) const {
  const Place& place = places_[p];
  const auto duration_s = static_cast<float>(times_s_.back() - times_s_.front());
  switch (product) {
    case Product::first_detection:
      return static_cast<float>(times_s_.front() + static_cast<double>(place.first_s));
    case Product::fraction:
      return place.covered_s / duration_s;
    case Product::gaps:
      return static_cast<float>(place.gaps);
    case Product::longest_gap:
      return place.longest_gap_s;
    case Product::revisit:
      if (place.coverages < 2) return NAN;
      return (place.last_begin_s - place.first_s) / static_cast<float>(place.coverages - 1);
    case Product::response:  // from a moment in a gap, half the gap on average
      return place.gaps_squared_s2 / (2 * duration_s);
    default:
      return place.gaps > 0 ? place.all_gaps_s / static_cast<float>(place.gaps) : 0.0f;
  }
}

}  // namespace emscape::study
