#include "study/time_figures.h"

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
  const auto length_s = static_cast<float>(at + 1 < times_s_.size() ? times_s_[at + 1] - times_s_[at] : 0);
  parallelFor(static_cast<int>(places_.size()), 1 << 14, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      Place& place = places_[p];
      if (isCovered(static_cast<std::size_t>(p))) {
        if (std::isnan(place.first_s)) place.first_s = static_cast<float>(time_s);
        place.covered_s += length_s;
        place.gap_s = 0;
      } else if (length_s > 0) {
        if (place.gap_s == 0) ++place.gaps;
        place.gap_s += length_s;
        place.all_gaps_s += length_s;
        place.longest_gap_s = std::max(place.longest_gap_s, place.gap_s);
      }
    }
  });
}

float TimeFigures::figure(Product product, std::size_t p) const {
  const Place& place = places_[p];
  switch (product) {
    case Product::first_detection:
      return place.first_s;
    case Product::fraction:
      return place.covered_s / static_cast<float>(times_s_.back() - times_s_.front());
    case Product::longest_gap:
      return place.longest_gap_s;
    default:
      return place.gaps > 0 ? place.all_gaps_s / static_cast<float>(place.gaps) : 0.0f;
  }
}

}  // namespace emscape::study
