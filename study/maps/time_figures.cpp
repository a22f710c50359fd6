#include "study/maps/time_figures.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::study {

TimeFigures::TimeFigures(std::size_t positions, std::vector<double> times_s) : times_s_(std::move(times_s)) {
  Pixel none;
  none.first_s = NAN;
  pixels_.assign(positions, none);
}

void TimeFigures::add(double time_s, const std::function<Coverage(std::size_t)>& coverageOf) {
  const std::size_t at = next_++;
  const auto since_first_s = static_cast<float>(time_s - times_s_.front());
  const auto length_s = static_cast<float>(at + 1 < times_s_.size() ? times_s_[at + 1] - times_s_[at] : 0);
  parallelFor(static_cast<int>(pixels_.size()), 1 << 14, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      Pixel& pixel = pixels_[p];
      const bool was_covered = pixel.is_covered;
      const Coverage coverage = coverageOf(static_cast<std::size_t>(p));
      pixel.is_covered = coverage == Coverage::yes;
      pixel.has_unknown = pixel.has_unknown || coverage == Coverage::unknown;
      if (pixel.is_covered) {
        if (std::isnan(pixel.first_s)) pixel.first_s = since_first_s;
        if (!was_covered) {
          ++pixel.coverages;
          pixel.last_begin_s = since_first_s;
        }
        pixel.covered_s += length_s;
        pixel.gap_s = 0;
      } else if (length_s > 0) {
        if (pixel.gap_s == 0) ++pixel.gaps;
        pixel.gaps_squared_s2 += length_s * (2 * pixel.gap_s + length_s);
        pixel.gap_s += length_s;
        pixel.all_gaps_s += length_s;
        pixel.longest_gap_s = std::max(pixel.longest_gap_s, pixel.gap_s);
      }
    }
  });
}

float TimeFigures::figure(Product product, std::size_t p) const {
  const Pixel& pixel = pixels_[p];
  const auto duration_s = static_cast<float>(times_s_.back() - times_s_.front());
  switch (product) {
    case Product::first_detection:
      return static_cast<float>(times_s_.front() + static_cast<double>(pixel.first_s));
    case Product::fraction:
      return pixel.covered_s / duration_s;
    case Product::gaps:
      return static_cast<float>(pixel.gaps);
    case Product::longest_gap:
      return pixel.longest_gap_s;
    case Product::revisit:
      if (pixel.coverages < 2) return NAN;
      return (pixel.last_begin_s - pixel.first_s) / static_cast<float>(pixel.coverages - 1);
    case Product::response:  // from a moment in a gap, half the gap on average
      return pixel.gaps_squared_s2 / (2 * duration_s);
    default:
      return pixel.gaps > 0 ? pixel.all_gaps_s / static_cast<float>(pixel.gaps) : 0.0f;
  }
}

PixelAnswer TimeFigures::answer(Product product, std::size_t p) const {
  const Pixel& pixel = pixels_[p];
  if (!pixel.has_unknown) return PixelAnswer::exact;
  const bool is_bounded = product == Product::first_detection || product == Product::fraction ||
                          product == Product::longest_gap || product == Product::response;
  return is_bounded && !std::isnan(pixel.first_s) ? PixelAnswer::bound : PixelAnswer::unknown;
}

}  // namespace emscape::study
