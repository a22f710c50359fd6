/// The march of one azimuth on the GPU, with the interface of RadialMarch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "emscape/base/units.h"
#include "propagation/parabolic_equation/march/march.h"
#include "propagation/parabolic_equation/march/march_azimuths.h"

namespace emscape::emfield {

/// Marches when the field is read, from the start up to the present range.
class GpuRadialMarch {
 public:
  GpuRadialMarch(const propagation::MarchGrid& grid, const std::array<propagation::RadialPath, 1>& paths) {
    const propagation::RadialPath& path = paths.front();
    march_.grid = grid;
    march_.source = path.source;
    march_.surface = path.surface;
    march_.air = {path.air};
    march_.azimuths = 1;
    march_.ground_msl_m.assign(path.ground_msl_m.begin(), path.ground_msl_m.end());
    march_.ground_steps = march_.ground_msl_m.size();
  }

  void advance() { ++steps_; }
  double range_m() const { return steps_ * march_.grid.range_step_m; }

  /// RadialMarch::factorDb().
  double factorDb(int /*lane*/, double height_agl_m) {
    const std::vector<float>& amplitude = column().amplitude;
    const double at = std::clamp(height_agl_m / column_.height_step_m, 0.0, double(amplitude.size() - 1));
    const std::size_t j = std::min(std::size_t(at), amplitude.size() - 2);
    const double u = amplitude[j] + (at - double(j)) * (double(amplitude[j + 1]) - double(amplitude[j]));
    return 20 * std::log10(u) + 10 * std::log10(spreading(height_agl_m));
  }

  /// RadialMarch::meanSquaredFactor().
  double meanSquaredFactor(int /*lane*/, double z1_m, double z2_m) {
    const std::vector<float>& amplitude = column().amplitude;
    const double dz = column_.height_step_m;
    const auto squared = [&](int j) {
      const double u = amplitude[std::size_t(j)];
      return u * u * spreading(j * dz);
    };
    double sum = 0;
    for (int j = int(z1_m / dz); j < int(std::ceil(z2_m / dz)); ++j) {
      const double a = std::max(z1_m / dz - j, 0.0), b = std::min(z2_m / dz - j, 1.0), middle = (a + b) / 2;
      sum += (b - a) * (squared(j) + middle * (squared(j + 1) - squared(j)));
    }
    return sum * dz / (z2_m - z1_m);
  }

 private:
  const propagation::FieldColumn& column() {
    if (column_.amplitude.empty() || column_.range_m != range_m()) {
      column_ = propagation::columnsOnGpu(march_, {steps_}).front();
    }
    return column_;
  }
  /// Wavelength times range, in the wide-angle form times the square of slant range over range.
  double spreading(double height_agl_m) const {
    const double source_m =
        march_.source.height_agl_m + (march_.ground_msl_m.empty() ? 0 : double(march_.ground_msl_m.front()));
    const double tangent = (column_.ground_msl_m + height_agl_m - source_m) / range_m();
    return wavelength_m(march_.grid.frequency_hz) * range_m() *
           (march_.grid.form == propagation::PeForm::wide ? 1 + tangent * tangent : 1);
  }

  propagation::AzimuthMarch march_;
  int steps_ = 0;
  propagation::FieldColumn column_;
};

}  // namespace emscape::emfield
