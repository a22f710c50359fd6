// The field at range 0.
#include <algorithm>
#include <cmath>

#include "propagation/parabolic_equation/march.h"

namespace emscape::propagation {
namespace {

using Cx = std::complex<double>;

/// Sum over n = 1..N-1 of sines[n] sin + cosines[n] cos of pi j n / N, at j = 0..N-1. The cosines by the sine
/// transform, with a = pi j / N: 2 sin a cos(n a) = sin((n + 1) a) - sin((n - 1) a).
std::vector<Cx> seriesSum(const std::vector<Cx>& sines, const std::vector<Cx>& cosines) {
  const int n = int(sines.size());
  SineTransform<double, 1> transform(n);
  using Value = LaneComplex<double, 1>;
  std::vector<Value> in(sines.size()), of_sines(sines.size()), of_cosines(sines.size());
  for (int i = 1; i < n; ++i) in[i] = {{sines[i].real()}, {sines[i].imag()}};
  transform(in.data(), of_sines.data());
  Cx at_zero = 0;
  for (int i = 1; i < n; ++i) {
    const Cx difference = (i > 1 ? cosines[i - 1] : 0) - (i + 1 < n ? cosines[i + 1] : 0);
    in[i] = {{difference.real()}, {difference.imag()}};
    at_zero += cosines[i];
  }
  transform(in.data(), of_cosines.data());
  std::vector<Cx> sum(sines.size());
  sum[0] = at_zero;
  for (int j = 1; j < n; ++j) {
    const double scale = 1 / (2 * std::sin(kPi * j / n));
    sum[j] = Cx(of_sines[j].re[0], of_sines[j].im[0]) + scale * Cx(of_cosines[j].re[0], of_cosines[j].im[0]);
  }
  return sum;
}

}  // namespace

/// The source as a sum of the discrete surface's waves e^(-i p z) + R e^(i p z), R(p) = -(1 - r e^(i p dz)) /
/// (1 - r e^(-i p dz)): for r = 0 the source and its image. The part of the delta at the source that the
/// surface wave r^j holds is put in by itself.
template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::start(int l) {
  const Lane& lane = lanes_[l];
  const PeSource& source = lane.path.source;
  const int n = intervals();
  const double dz = heightStep_m(), k = grid_.wavenumber(), p_max = kPi / dz;
  const bool wide = grid_.form == PeForm::wide;
  std::vector<Cx> sines(n), cosines(n);
  for (int i = 1; i < n; ++i) {
    const double p = kPi * i / grid_.top_m;
    const Cx turn = std::polar(1.0, p * dz);
    const Cx reflected = -(1.0 - lane.ratio * turn) / (1.0 - lane.ratio * std::conj(turn));
    const Cx above = sourceSpectrum(source, p, p_max, k, wide) / (2 * grid_.top_m);
    const Cx below = sourceSpectrum(source, -p, p_max, k, wide) / (2 * grid_.top_m);
    const Cx up = above + reflected * below, down = below + above / reflected;
    cosines[i] = up + down;
    sines[i] = Cx(0, 1) * (up - down);
  }
  std::vector<Cx> values = seriesSum(sines, cosines);
  if (lane.ratio != 0.0) {
    Cx power = 1, with_field = 0, with_itself = 0;
    for (int j = 0; j < n; ++j, power *= lane.ratio) {
      with_field += power * values[j];
      with_itself += power * power;
    }
    const Cx at_source = std::pow(lane.ratio, source.height_agl_m / dz) / dz;
    const Cx missing = (at_source - with_field) / with_itself;
    power = 1;
    for (int j = 0; j < n; ++j, power *= lane.ratio) values[j] += missing * power;
  } else {
    values[0] = 0;
  }
  setField(l, values);
}

template class RadialMarch<double, 1>;
template class RadialMarch<double, 4>;
template class RadialMarch<float, 1>;
template class RadialMarch<float, 8>;

}  // namespace emscape::propagation
