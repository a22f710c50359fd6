/// Links over synthetic hills, the same in every run, for the benchmarks of ITM.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "propagation/itm/itm.h"

namespace emscape::bench {

struct ItmCases {
  int intervals = 0;
  std::vector<float> heights_msl_m;  ///< `intervals` + 1 per case
  std::vector<propagation::ItmLink<double>> links;

  const float* profile(std::size_t i) const {
    return heights_msl_m.data() + i * (static_cast<std::size_t>(intervals) + 1);
  }
};

inline ItmCases makeItmCases(int count, int intervals) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  ItmCases cases;
  cases.intervals = intervals;
  for (int i = 0; i < count; ++i) {
    std::vector<float> heights(static_cast<std::size_t>(intervals) + 1, 400.0f);
    for (double waves = 1; waves < intervals / 2; waves *= 1.7) {
      const double amplitude_m = 300 * uniform(random) / waves;
      const double phase = 6.28 * uniform(random);
      for (std::size_t post = 0; post < heights.size(); ++post) {
        heights[post] += static_cast<float>(
            amplitude_m * std::sin(phase + 6.28 * waves * static_cast<double>(post) / intervals));
      }
    }
    cases.heights_msl_m.insert(cases.heights_msl_m.end(), heights.begin(), heights.end());
    // values that are exact in float, so that float and double compute the same link
    propagation::ItmLink<double> link;
    link.height_agl_m[0] = static_cast<float>(5 + 100 * uniform(random));
    link.height_agl_m[1] = static_cast<float>(2 + 50 * uniform(random));
    link.frequency_hz = static_cast<float>(50e6 * std::pow(100.0, uniform(random)));
    link.climate = static_cast<propagation::ItmClimate>(1 + i % 7);
    cases.links.push_back(link);
  }
  return cases;
}

template <class Real>
propagation::ItmLink<Real> linkAs(const propagation::ItmLink<double>& link) {
  propagation::ItmLink<Real> same;
  for (int end = 0; end < 2; ++end) same.height_agl_m[end] = static_cast<Real>(link.height_agl_m[end]);
  same.frequency_hz = static_cast<Real>(link.frequency_hz);
  same.climate = link.climate;
  return same;
}

}  // namespace emscape::bench
