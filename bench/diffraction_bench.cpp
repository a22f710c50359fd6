// Delta-Bullington over planes of 200 ranges x 100 heights: the sweep against path by path, on one core.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "base/units.h"
#include "emfield/models/diffraction_sweep.h"

namespace {

using namespace emscape;
using namespace emscape::emfield;

constexpr int kRanges = 200, kHeights = 100;
constexpr double kLength_m = 60e3;

/// Hills of several sizes, 600 m from the lowest to the highest.
struct Hills {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;

  explicit Hills(int posts, double phase) {
    for (int i = 0; i < posts; ++i) {
      const double x = kLength_m * i / (posts - 1);
      range_m.push_back(x);
      double height = 400;
      for (int k = 0; k < 6; ++k)
        height += 160 / (k + 1.0) * std::sin(phase * (k + 1) + x / 9000 * std::pow(2.2, k));
      height_msl_m.push_back(float(height));
    }
  }
  TerrainProfile profile() const { return {range_m.data(), height_msl_m.data(), int(range_m.size())}; }
};

/// Least time (s) of the calling thread over some runs.
template <class Run>
double fastest_s(Run run) {
  double least = 1e9;
  for (int i = 0; i < 7; ++i) {
    const std::clock_t begin = std::clock();
    run();
    least = std::min(least, double(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

template <class Real>
void measure(const char* real, int posts_per_range, double top_msl_m) {
  const int posts = (kRanges - 1) * posts_per_range + 1;
  double path_s = 0, sweep_s = 0, largest_db = 0;
  std::vector<Real> heights, by_path(kHeights * kRanges), by_sweep(by_path.size());
  for (int j = 0; j < kHeights; ++j) heights.push_back(Real(top_msl_m * (j + 1) / kHeights));
  DiffractionMemory<Real> memory(posts);
  for (const double frequency_hz : {1e8, 1e9, 1e10}) {
    const Hills hills(posts, std::log(frequency_hz));
    DiffractionParameters parameters;
    parameters.frequency_hz = frequency_hz;
    parameters.effective_earth_radius_m = 6371000 * 4.0 / 3;
    const auto model = diffractionModel<Real>(parameters);
    const Real tx = Real(hills.height_msl_m[0] + 20);
    path_s += fastest_s([&] {
      for (int r = 1; r < kRanges; ++r) {
        const TerrainProfile path = hills.profile().upTo(r * posts_per_range);
        for (int j = 0; j < kHeights; ++j) {
          by_path[std::size_t(r * kHeights + j)] =
              deltaBullington(model, path, tx, heights[std::size_t(j)]).loss_db;
        }
      }
    });
    sweep_s += fastest_s([&] {
      DiffractionSweep<Real> sweep(model, hills.profile(), tx, memory.scratch());
      for (int r = 1; r < kRanges; ++r) {
        while (sweep.post() < r * posts_per_range) sweep.advance();
        sweep.column(heights.data(), kHeights, &by_sweep[std::size_t(r * kHeights)]);
      }
    });
    for (std::size_t i = kHeights; i < by_path.size(); ++i) {
      largest_db = std::max(largest_db, double(std::abs(by_path[i] - by_sweep[i])));
    }
  }
  fmt::print(
      "{:6} {:5} posts, heights to {:5.0f} m: path by path {:8.2f} ms, sweep {:6.3f} ms a plane, ratio "
      "{:5.1f}, "
      "difference {:.1e} dB\n",
      real, posts, top_msl_m, path_s / 3 * 1e3, sweep_s / 3 * 1e3, path_s / sweep_s, largest_db);
}

}  // namespace

int main() {
  for (const int posts_per_range : {1, 4}) {
    for (const double top_msl_m : {2000.0, 6000.0, 10000.0}) {
      measure<double>("double", posts_per_range, top_msl_m);
      measure<float>("float", posts_per_range, top_msl_m);
    }
  }
}
