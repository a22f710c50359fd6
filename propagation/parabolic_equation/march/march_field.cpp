// The field of a march: read, replaced, cut.
#include <algorithm>
#include <cmath>

#include "propagation/parabolic_equation/march/march.h"
#include "propagation/parabolic_equation/march/march_start.h"

namespace emscape::propagation {

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::setField(int l, const std::vector<std::complex<double>>& values) {
  for (int j = 0; j < intervals(); ++j) {
    field_[j].re[l] = Real(values[j].real());
    field_[j].im[l] = Real(values[j].imag());
  }
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::amplitude(int l, double height_agl_m) const {
  const double at = std::clamp(height_agl_m / heightStep_m(), 0.0, double(intervals() - 1));
  const int j = std::min(int(at), intervals() - 2);
  const auto magnitude = [&](int i) { return std::hypot(double(field_[i].re[l]), double(field_[i].im[l])); };
  return magnitude(j) + (at - j) * (magnitude(j + 1) - magnitude(j));
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::slantSquared(double rise_m) const {
  return grid_.form == PeForm::wide ? 1 + rise_m / range_m() * (rise_m / range_m()) : 1;
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::factorDb(int l, double height_agl_m) const {
  const Lane& lane = lanes_[l];
  const double source_m = groundAt(lane.path, 0) + lane.path.source.height_agl_m;
  MarchGrid now = grid_;
  now.intervals = intervals();
  const int halvings = int(std::lround(std::log2(double(grid_.intervals) / intervals())));
  const double height_m = std::min(height_agl_m, grid_.top_m - heightStep_m());
  const std::vector<std::complex<double>> receiver = startField(now, {height_m, {}}, lane.ratio, halvings);
  std::complex<double> received = 0;
  for (int j = 0; j < intervals(); ++j)
    received += receiver[j] * std::complex<double>(double(field_[j].re[l]), double(field_[j].im[l]));
  const double slant_m = range_m() * std::sqrt(slantSquared(lane.ground_m + height_agl_m - source_m));
  return 20 * std::log10(std::abs(received) * heightStep_m()) +
         10 * std::log10(wavelength_m(grid_.frequency_hz) * slant_m);
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::meanSquaredFactor(int l, double z1_m, double z2_m) const {
  const Lane& lane = lanes_[l];
  const double dz = heightStep_m(), source_m = groundAt(lane.path, 0) + lane.path.source.height_agl_m;
  const double spreading = wavelength_m(grid_.frequency_hz) * range_m();
  const auto squared = [&](int j) {
    const double re = field_[j].re[l], im = field_[j].im[l];
    return (re * re + im * im) * spreading * slantSquared(lane.ground_m + j * dz - source_m);
  };
  // |u|^2 is taken as linear between the heights
  double sum = 0;
  const int first = std::clamp(int(z1_m / dz), 0, intervals() - 2);
  const int last = std::clamp(int(std::ceil(z2_m / dz)), first + 1, intervals() - 1);
  for (int j = first; j < last; ++j) {
    const double a = std::max(z1_m / dz - j, 0.0), b = std::min(z2_m / dz - j, 1.0), middle = (a + b) / 2;
    sum += (b - a) * (squared(j) + middle * (squared(j + 1) - squared(j)));
  }
  return sum * dz / (z2_m - z1_m);
}

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::screenBelow(int l, double height_agl_m) {
  const double edge = height_agl_m / heightStep_m();
  for (int j = 0; j < intervals() && j <= edge; ++j) {
    const Real keep = std::fabs(j - edge) < 1e-9 ? Real(0.5) : Real(0);
    field_[j].re[l] *= keep;
    field_[j].im[l] *= keep;
  }
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::energy(int l) const {
  double sum = 0;
  for (const Value& u : field_) sum += double(u.re[l]) * u.re[l] + double(u.im[l]) * u.im[l];
  return sum * heightStep_m();
}

template class RadialMarch<double, 1>;
template class RadialMarch<float, 1>;

}  // namespace emscape::propagation
