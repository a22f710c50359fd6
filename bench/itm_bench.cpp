// Speed of ITM, point-to-point, on one core: evaluations a second at profiles of 300 posts.
//
//   cmake -DEMSCAPE_BENCH=ON ...; itm_bench [intervals]
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include "emfield/models/itm.h"

namespace {

using namespace emscape::emfield;

constexpr int kProfiles = 200;
constexpr int kEvaluations = 100000;
constexpr int kRepeats = 5;

/// Hills of many sizes and, at random, links over them.
struct Cases {
  std::vector<std::vector<float>> heights_msl_m;
  std::vector<ItmLink<double>> links;
};

Cases makeCases(int intervals) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  Cases cases;
  for (int i = 0; i < kProfiles; ++i) {
    std::vector<float> heights(static_cast<std::size_t>(intervals) + 1, 400.0f);
    for (double waves = 1; waves < intervals / 2; waves *= 1.7) {
      const double amplitude_m = 300 * uniform(random) / waves;
      const double phase = 6.28 * uniform(random);
      for (std::size_t post = 0; post < heights.size(); ++post) {
        heights[post] += static_cast<float>(
            amplitude_m * std::sin(phase + 6.28 * waves * static_cast<double>(post) / intervals));
      }
    }
    cases.heights_msl_m.push_back(heights);
    ItmLink<double> link;
    link.height_agl_m[0] = 5 + 100 * uniform(random);
    link.height_agl_m[1] = 2 + 50 * uniform(random);
    link.frequency_hz = 50e6 * std::pow(100.0, uniform(random));
    cases.links.push_back(link);
  }
  return cases;
}

template <class Real>
ItmLink<Real> linkAs(const ItmLink<double>& link) {
  ItmLink<Real> same;
  for (int end = 0; end < 2; ++end) same.height_agl_m[end] = static_cast<Real>(link.height_agl_m[end]);
  same.frequency_hz = static_cast<Real>(link.frequency_hz);
  return same;
}

template <class Real>
void measure(const char* name, const Cases& cases, int intervals) {
  std::vector<double> per_second;
  double sum_db = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const std::clock_t start = std::clock();  // of this process: other load on the machine does not count
    for (int i = 0; i < kEvaluations; ++i) {
      const auto which = static_cast<std::size_t>(i % kProfiles);
      const ItmProfile<float> profile{cases.heights_msl_m[which].data(), intervals, 90.0 + i % 7};
      sum_db += static_cast<double>(
          itmPointToPoint(profile, linkAs<Real>(cases.links[which]), ItmQuantiles<Real>()).loss_db);
    }
    per_second.push_back(kEvaluations / (static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC));
  }
  std::sort(per_second.begin(), per_second.end());
  fmt::print("{}: {:.0f} evaluations/s of CPU time (median of {}; best {:.0f}); mean loss {:.3f} dB\n", name,
             per_second[kRepeats / 2], kRepeats, per_second.back(), sum_db / kEvaluations / kRepeats);
}

}  // namespace

int main(int argc, char** argv) {
  const int intervals = argc > 1 ? std::atoi(argv[1]) : 299;
  const Cases cases = makeCases(intervals);
  fmt::print("ITM point-to-point, {} posts, one core\n", intervals + 1);
  measure<double>("double", cases, intervals);
  measure<float>("float", cases, intervals);
}
