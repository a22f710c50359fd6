/// Common to the checks of the parabolic equation: grids whose nodes include the heights of a table, and
/// figures of many differences.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "emfield/check/gpu_radial_march.h"
#include "emfield/check/reference_check.h"
#include "propagation/parabolic_equation/march/march.h"
#include "propagation/parabolic_equation/march/march_azimuths.h"

namespace emscape::emfield {

/// A grid whose height step divides node_m.
/// @param angle_deg  minimum angle of the band
/// @param top_m      minimum height of the domain
inline propagation::MarchGrid peGrid(double frequency_hz, double angle_deg, double top_m, double node_m,
                                     double range_step_m) {
  propagation::MarchGrid grid;
  grid.frequency_hz = frequency_hz;
  const double largest_m = wavelength_m(frequency_hz) / (2 * std::sin(degToRad(angle_deg)));
  const double step_m = node_m / std::ceil(node_m / largest_m);
  grid.intervals = 1 << static_cast<int>(std::ceil(std::log2(top_m / step_m)));
  grid.top_m = grid.intervals * step_m;
  grid.range_step_m = range_step_m;
  setAbsorber(grid);
  return grid;
}

/// Stands for the march on the GPU, in float, as an alternative to double and float.
struct OnGpu {};

template <class Real>
struct PeMarchOf {
  using Type = propagation::RadialMarch<Real, 1>;
};
template <>
struct PeMarchOf<OnGpu> {
  using Type = GpuRadialMarch;
};
template <class Real>
using PeMarch = typename PeMarchOf<Real>::Type;

/// True if the march on the GPU supports the grid.
inline bool fitsGpu(const propagation::MarchGrid& grid) {
  return grid.intervals >= propagation::kMinBlockIntervals &&
         grid.intervals <= propagation::kMaxBlockIntervals;
}

/// Marches to a range, a multiple of the range step not less than the present range.
template <class March>
void marchTo(March& march, double range_m) {
  while (march.range_m() < range_m - 1e-3) march.advance();
}

/// "F, float".
template <class Real>
std::string inPrecision(const std::string& figure) {
  return figure + (std::is_same_v<Real, OnGpu>   ? ", GPU"
                   : std::is_same_v<Real, float> ? ", float"
                                                 : ", double");
}

/// Differences of many cases, for figures of a share of them.
class Differences {
 public:
  void add(double computed, double expected, int line) {
    all_.push_back({std::fabs(computed - expected), line});
  }

  /// The difference that is not exceeded by a share (0..1) of the cases.
  FigureCheck figure(const std::string& name, double share, double tolerance) const {
    FigureCheck found{name, tolerance, "dB"};
    if (all_.empty()) return found;
    std::vector<Difference> sorted = all_;
    std::sort(sorted.begin(), sorted.end(), [](const Difference& a, const Difference& b) {
      // NaN last
      return std::isnan(b.value) ? !std::isnan(a.value) : a.value < b.value;
    });
    const std::size_t index = std::min(sorted.size() - 1, static_cast<std::size_t>(share * sorted.size()));
    found.compare(sorted[index].value, 0, sorted[index].line);
    return found;
  }

 private:
  struct Difference {
    double value;
    int line;
  };
  std::vector<Difference> all_;
};

}  // namespace emscape::emfield
