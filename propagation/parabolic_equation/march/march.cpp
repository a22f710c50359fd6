// The steps of a march.
#include "propagation/parabolic_equation/march/march.h"

#include <algorithm>
#include <cmath>

#include "propagation/parabolic_equation/march/march_start.h"
#include "propagation/parabolic_equation/march/march_step.h"

namespace emscape::propagation {
namespace {

using Cx = std::complex<double>;

/// Max fraction of the power in the upper half of the spectrum when it is dropped.
constexpr double kNegligible = 1e-6;

/// exp(stepExponent()).
Cx propagated(const MarchGrid& grid, double distance_m, Cx q_squared, double loss = 0) {
  Complex<double> exponent = stepExponent(grid.form == PeForm::wide, grid.wavenumber(), distance_m,
                                          {q_squared.real(), q_squared.imag()});
  exponent.re -= loss;
  const Complex<double> factor = exponential(exponent);
  return {factor.re, factor.im};
}

}  // namespace

template <class Real, int kLanes>
RadialMarch<Real, kLanes>::RadialMarch(const MarchGrid& grid, std::array<RadialPath, kLanes> paths)
    : grid_((checkGrid(grid), grid)),
      sines_(grid.intervals),
      field_(grid.intervals),
      spectrum_(grid.intervals),
      scratch_(grid.intervals),
      half_screen_(grid.intervals),
      propagator_(grid.intervals) {
  for (RadialPath& path : paths) {
    Lane lane;
    lane.path = std::move(path);
    lanes_.push_back(std::move(lane));
  }
  for (int l = 0; l < kLanes; ++l) {
    Lane& lane = lanes_[l];
    checkSource(grid_, lane.path.source, lane.path.surface);
    checkGround(grid_, lane.path.ground_msl_m.data(), lane.path.ground_msl_m.size());
    lane.ground_m = groundAt(lane.path, 0);
    setRatio(l);
    setField(l, startField(grid_, lane.path.source, lane.ratio));
    setPropagator(l);
    setScreen(l);
  }
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::groundAt(const RadialPath& path, int step) const {
  if (path.ground_msl_m.empty()) return 0;
  return path.ground_msl_m[std::min(std::size_t(step), path.ground_msl_m.size() - 1)];
}

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::setRatio(int l) {
  lanes_[l].ratio = checkedRatio(grid_, lanes_[l].path.surface, heightStep_m());
}

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::setScreen(int l) {
  const Lane& lane = lanes_[l];
  const RefractivityProfile profile = lane.path.air.at(range_m() + grid_.range_step_m / 2);
  const double k = grid_.wavenumber(), dz = heightStep_m(), surface_m_units = profile.at(lane.ground_m);
  const double half_step_m = grid_.range_step_m / 2 / lane.cosine;
  const double middle_m = lane.ground_m + grid_.range_step_m / 2 * lane.sine / lane.cosine;
  for (int j = 0; j < intervals(); ++j) {
    const double m = 1e-6 * (profile.at(middle_m + j * dz) - surface_m_units);
    const double phase = k * half_step_m * (grid_.form == PeForm::wide ? m : m + m * m / 2);
    const double t = (j * dz - grid_.usableTop_m()) / grid_.absorber_m;
    const double magnitude = t > 0 ? std::exp(-grid_.absorber_per_m * t * t * t * half_step_m) : 1;
    half_screen_[j].re[l] = Real(magnitude * std::cos(phase));
    half_screen_[j].im[l] = Real(magnitude * std::sin(phase));
  }
}

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::setPropagator(int l) {
  const double cosine = lanes_[l].cosine;
  const double distance_m = grid_.range_step_m / cosine;
  const bool over_terrain = !lanes_[l].path.ground_msl_m.empty();
  for (int i = 0; i < intervals(); ++i) {
    const double q = kPi * i / grid_.top_m / cosine;
    const double loss = grid_.absorber_m > 0 ? bandEdgeRate(double(i) / intervals(), maxSine(),
                                                            grid_.range_step_m, over_terrain)
                                             : 0;
    const Cx factor = propagated(grid_, distance_m, q * q, loss * distance_m) * (2.0 / intervals());
    propagator_[i].re[l] = Real(factor.real());
    propagator_[i].im[l] = Real(factor.imag());
  }
}

template <class Real, int kLanes>
double RadialMarch<Real, kLanes>::bend(int l) {
  Lane& lane = lanes_[l];
  const double rise_m = groundAt(lane.path, steps_ + 1) - lane.ground_m;
  const GroundStep step =
      groundStep(rise_m, grid_.range_step_m, lane.sine, steps_ == 0, maxSine(), grid_.slope_part);
  if (step.sine == lane.sine) return step.stair_m;
  const double phase = grid_.wavenumber() * heightStep_m() * step.turn;
  for (int j = 0; j < intervals(); ++j) {
    const double angle = std::remainder(phase * j, 2 * kPi), c = std::cos(angle), s = std::sin(angle);
    const double re = field_[j].re[l], im = field_[j].im[l];
    field_[j].re[l] = Real(re * c - im * s);
    field_[j].im[l] = Real(re * s + im * c);
  }
  lane.sine = step.sine;
  lane.cosine = step.cosine;
  setPropagator(l);
  return step.stair_m;
}

/// u -> v[j] = u[j] - r u[j-1], v[0] = 0; stores the surface wave's amplitude A.
template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::splitSurface(int l) {
  Lane& lane = lanes_[l];
  Cx power = 1, with_field = 0, with_itself = 0;
  for (int j = 0; j < intervals(); ++j, power *= lane.ratio) {
    with_field += power * Cx(field_[j].re[l], field_[j].im[l]);
    with_itself += power * power;
  }
  const Cx a = with_field / with_itself;
  lane.surface_wave = {Real(a.real()), Real(a.imag())};
  const Complex<Real> r{Real(lane.ratio.real()), Real(lane.ratio.imag())};
  Complex<Real> below{field_[0].re[l], field_[0].im[l]};
  for (int j = 1; j < intervals(); ++j) {
    const Complex<Real> u{field_[j].re[l], field_[j].im[l]}, v = u - r * below;
    field_[j].re[l] = v.re;
    field_[j].im[l] = v.im;
    below = u;
  }
  field_[0].re[l] = field_[0].im[l] = 0;
}

/// v -> u, with the surface wave one step further.
template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::joinSurface(int l) {
  Lane& lane = lanes_[l];
  const Complex<Real> r{Real(lane.ratio.real()), Real(lane.ratio.imag())};
  Complex<Real> y;
  Cx power = 1, with_field = 0, with_itself = 0;
  for (int j = 0; j < intervals(); ++j, power *= lane.ratio) {
    y = j == 0 ? Complex<Real>{} : Complex<Real>{field_[j].re[l], field_[j].im[l]} + r * y;
    field_[j].re[l] = y.re;
    field_[j].im[l] = y.im;
    with_field += power * Cx(y.re, y.im);
    with_itself += power * power;
  }
  const double cosine = lane.cosine;
  const Cx decay = std::log(lane.ratio) / (heightStep_m() * cosine);
  const Cx a = Cx(lane.surface_wave.re, lane.surface_wave.im) *
                   propagated(grid_, grid_.range_step_m / cosine, -decay * decay) -
               with_field / with_itself;
  power = a;
  for (int j = 0; j < intervals(); ++j, power *= lane.ratio) {
    field_[j].re[l] += Real(power.real());
    field_[j].im[l] += Real(power.imag());
  }
}

/// Shifts the field by whole height steps: the ground rises (> 0) or falls.
template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::shift(int l, double rise_m) {
  const int n = intervals(), by = int(std::lround(rise_m / heightStep_m()));
  lanes_[l].ground_m += by * heightStep_m();
  for (int i = 0; i < n; ++i) {
    const int j = by > 0 ? i : n - 1 - i, from = j + by;
    const bool inside = from >= 0 && from < n && j > 0;
    field_[j].re[l] = inside ? field_[from].re[l] : Real(0);
    field_[j].im[l] = inside ? field_[from].im[l] : Real(0);
  }
}

template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::advance() {
  std::array<double, kLanes> staircase_m;
  for (int l = 0; l < kLanes; ++l) {
    Lane& lane = lanes_[l];
    staircase_m[l] = bend(l);
    if (!lane.path.ground_msl_m.empty() || !lane.path.air.constant()) setScreen(l);
  }
  const int n = intervals();
  for (int j = 0; j < n; ++j) field_[j] = field_[j] * half_screen_[j];
  for (int l = 0; l < kLanes; ++l) {
    if (lanes_[l].ratio != 0.0) splitSurface(l);
  }
  sines_(field_.data(), spectrum_.data());
  for (int i = 0; i < n; ++i) spectrum_[i] = spectrum_[i] * propagator_[i];
  sines_(spectrum_.data(), field_.data());
  for (int l = 0; l < kLanes; ++l) {
    if (lanes_[l].ratio != 0.0) joinSurface(l);
  }
  for (int j = 0; j < n; ++j) field_[j] = field_[j] * half_screen_[j];
  ++steps_;
  for (int l = 0; l < kLanes; ++l) {
    Lane& lane = lanes_[l];
    lane.ground_m += grid_.range_step_m * lane.sine / lane.cosine;
    if (staircase_m[l] != 0) shift(l, staircase_m[l]);
  }
  if (grid_.halving) halveIfEmpty();
}

/// Halves N if the rays of the band's upper half have left the domain, as the spectrum shows in every lane.
template <class Real, int kLanes>
void RadialMarch<Real, kLanes>::halveIfEmpty() {
  const int n = intervals();
  const double sine = maxSine() / 2;
  if (n <= 128 || sine >= 1) return;
  const double tangent = std::tan(std::asin(sine));
  const double length_m = 1.5 * grid_.top_m / tangent;
  if (range_m() < length_m) return;
  // not at every step where a slope keeps the upper half filled
  const int pause = std::max(1, int(length_m / 8 / grid_.range_step_m));
  if (steps_ % pause != 0) return;
  scratch_ = field_;
  for (int l = 0; l < kLanes; ++l) {
    if (lanes_[l].ratio == 0.0) continue;
    // the mixed transform's spectrum: without the surface wave
    const Complex<Real> r{Real(lanes_[l].ratio.real()), Real(lanes_[l].ratio.imag())};
    for (int j = n - 1; j > 0; --j) {
      const Complex<Real> v = Complex<Real>{field_[j].re[l], field_[j].im[l]} -
                              r * Complex<Real>{field_[j - 1].re[l], field_[j - 1].im[l]};
      scratch_[j].re[l] = v.re;
      scratch_[j].im[l] = v.im;
    }
  }
  sines_(scratch_.data(), spectrum_.data());
  for (int l = 0; l < kLanes; ++l) {
    double all = 0, upper = 0;
    for (int i = 1; i < n; ++i) {
      const double power =
          double(spectrum_[i].re[l]) * spectrum_[i].re[l] + double(spectrum_[i].im[l]) * spectrum_[i].im[l];
      all += power;
      if (i >= n / 2) upper += power;
    }
    if (upper > kNegligible * all) return;
  }
  for (int j = 0; j < n / 2; ++j) field_[j] = field_[2 * j];
  sines_ = SineTransform<Real, kLanes>(n / 2);
  for (auto* values : {&field_, &spectrum_, &scratch_, &half_screen_, &propagator_}) values->resize(n / 2);
  for (int l = 0; l < kLanes; ++l) {
    setRatio(l);
    setPropagator(l);
    setScreen(l);
  }
}

template class RadialMarch<double, 1>;
template class RadialMarch<float, 1>;

}  // namespace emscape::propagation
