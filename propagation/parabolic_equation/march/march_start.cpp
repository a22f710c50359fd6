#include "propagation/parabolic_equation/march/march_start.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "propagation/parabolic_equation/march/sine_transform.h"

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
/// (1 - r e^(-i p dz)): for r = 0 the source and its image. The surface wave r^j of the
/// delta at the source is added separately.
std::vector<Cx> startField(const MarchGrid& grid, const PeSource& source, Cx ratio, int halvings) {
  const int n = grid.intervals;
  const double dz = grid.heightStep_m(), k = grid.wavenumber(), p_max = kPi / dz * (1 << halvings);
  const bool wide = grid.form == PeForm::wide;
  std::vector<Cx> sines(n), cosines(n);
  for (int i = 1; i < n; ++i) {
    const double p = kPi * i / grid.top_m;
    const Cx turn = std::polar(1.0, p * dz);
    const Cx reflected = -(1.0 - ratio * turn) / (1.0 - ratio * std::conj(turn));
    const Cx above = sourceSpectrum(source, p, p_max, k, wide) / (2 * grid.top_m);
    const Cx below = sourceSpectrum(source, -p, p_max, k, wide) / (2 * grid.top_m);
    const Cx up = above + reflected * below, down = below + above / reflected;
    cosines[i] = up + down;
    sines[i] = Cx(0, 1) * (up - down);
  }
  std::vector<Cx> values = seriesSum(sines, cosines);
  if (ratio != 0.0) {
    Cx power = 1, with_field = 0, with_itself = 0;
    for (int j = 0; j < n; ++j, power *= ratio) {
      with_field += power * values[j];
      with_itself += power * power;
    }
    const Cx at_source = std::pow(ratio, source.height_agl_m / dz) / dz;
    const Cx missing = (at_source - with_field) / with_itself;
    power = 1;
    for (int j = 0; j < n; ++j, power *= ratio) values[j] += missing * power;
  } else {
    values[0] = 0;
  }
  return values;
}

void checkSource(const MarchGrid& grid, const PeSource& source, const PeSurface& surface) {
  const double height_m = source.height_agl_m;
  const bool radiates = surface.perfect ? height_m > 0 : height_m >= 0;
  if (radiates && height_m <= grid.usableTop_m()) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("antenna {:.4g} m above the ground; expected {} 0, up to {:.4g} m", height_m,
                          surface.perfect ? "above" : "at least", grid.usableTop_m()));
}

template <class Height>
void checkGround(const MarchGrid& grid, const Height* ground_m, std::size_t steps) {
  const auto hole = std::find_if(ground_m, ground_m + steps, [](Height h) { return !std::isfinite(h); });
  if (hole == ground_m + steps) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("no terrain {} m from the antenna", double(hole - ground_m) * grid.range_step_m));
}

template void checkGround<float>(const MarchGrid&, const float*, std::size_t);
template void checkGround<double>(const MarchGrid&, const double*, std::size_t);

Cx checkedRatio(const MarchGrid& grid, const PeSurface& surface, double height_step_m) {
  const Cx ratio = surfaceRatio(surface, grid.frequency_hz, height_step_m);
  if (std::abs(ratio) <= kMaxSurfaceRatio) return ratio;
  throw Error(ErrorCode::bad_input,
              fmt::format("|r| of the surface is {:.6g} at {:.4g} degrees and height steps of {:.4g} "
                          "m; the mixed transform holds up to {}",
                          std::abs(ratio), radToDeg(surface.grazing_rad), height_step_m, kMaxSurfaceRatio));
}

}  // namespace emscape::propagation
