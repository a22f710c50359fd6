// Speed of ITM, point-to-point, on one core: evaluations a second of CPU time at profiles of 300 posts.
//
//   cmake -DEMSCAPE_BENCH=ON ...; itm_bench [intervals]
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "bench/itm_cases.h"

namespace {

using namespace emscape;

constexpr int kProfiles = 200;
constexpr int kEvaluations = 100000;
constexpr int kRepeats = 5;

template <class Real>
void measure(const char* name, const bench::ItmCases& cases) {
  std::vector<double> per_second;
  double sum_db = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const std::clock_t start = std::clock();  // of this process: other load on the machine does not count
    for (int i = 0; i < kEvaluations; ++i) {
      const auto which = static_cast<std::size_t>(i % kProfiles);
      const emfield::ItmProfile<float> profile{cases.profile(which), cases.intervals, 90.0 + i % 7};
      sum_db += static_cast<double>(emfield::itmPointToPoint(profile, bench::linkAs<Real>(cases.links[which]),
                                                             emfield::ItmQuantiles<Real>())
                                        .loss_db);
    }
    per_second.push_back(kEvaluations / (static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC));
  }
  std::sort(per_second.begin(), per_second.end());
  fmt::print("{}: {:.0f} evaluations/s (median of {}; best {:.0f}); mean loss {:.3f} dB\n", name,
             per_second[kRepeats / 2], kRepeats, per_second.back(), sum_db / kEvaluations / kRepeats);
}

}  // namespace

int main(int argc, char** argv) {
  const int intervals = argc > 1 ? std::atoi(argv[1]) : 299;
  if (intervals < 2) {
    fmt::print(stderr, "itm_bench: {} intervals; at least 2\n", intervals);
    return 2;
  }
  const bench::ItmCases cases = bench::makeItmCases(kProfiles, intervals);
  fmt::print("ITM point-to-point, {} posts, one core\n", intervals + 1);
  measure<double>("double", cases);
  measure<float>("float", cases);
}
