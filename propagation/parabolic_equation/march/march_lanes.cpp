#include "propagation/parabolic_equation/march/march_lanes.h"

#include <cstring>

#include "base/math/simd_targets.h"
#include "propagation/parabolic_equation/march/march_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "propagation/parabolic_equation/march/march_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace emscape::propagation {
namespace HWY_NAMESPACE {

/// A float of each lane; half of a register of AVX-512, two of the plain kind.
using V = float __attribute__((vector_size(32), may_alias));
using Integers = int __attribute__((vector_size(32)));

HWY_INLINE V load(const float* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
HWY_INLINE void store(V v, float* to) {
  std::memcpy(to, &v, sizeof v);
}
HWY_INLINE V all(float a) {
  return V{} + a;
}

template <class Real>
struct Complex {
  Real re, im;
};
template <class Real>
using ScalarOf = float;

HWY_INLINE Complex<V> operator+(Complex<V> a, Complex<V> b) {
  return {a.re + b.re, a.im + b.im};
}
HWY_INLINE Complex<V> operator-(Complex<V> a, Complex<V> b) {
  return {a.re - b.re, a.im - b.im};
}
template <class Factor>
HWY_INLINE Complex<V> operator*(Complex<V> a, Complex<Factor> b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
template <class Factor>
HWY_INLINE Complex<V> timesConjugate(Complex<V> a, Complex<Factor> b) {
  return {a.re * b.re + a.im * b.im, a.im * b.re - a.re * b.im};
}
HWY_INLINE Complex<V> negative(Complex<V> a) {
  return {-a.re, -a.im};
}
HWY_INLINE Complex<V> load(const StepLanes& from) {
  return {load(from.re), load(from.im)};
}
HWY_INLINE void store(Complex<V> a, StepLanes& to) {
  store(a.re, to.re);
  store(a.im, to.im);
}
HWY_INLINE Complex<float> load(const StoredComplex& from) {
  return {from.re, from.im};
}

#undef EMSCAPE_HD
#define EMSCAPE_HD HWY_INLINE
#include "propagation/parabolic_equation/march/small_fourier-inl.h"
#undef EMSCAPE_HD
#define EMSCAPE_HD

/// cos and sin of 2 pi turns, within 1e-7 of the reduced argument's; |turns| < 2^20.
HWY_INLINE Complex<V> unitTurn(V turns) {
  const V magic = all(12582912.0F);  // 1.5 * 2^23: the sum is the nearest integer
  const V shifted = turns * 4.0F + magic;
  Integers quarter;
  std::memcpy(&quarter, &shifted, sizeof quarter);
  const V a = (turns - (shifted - magic) * 0.25F) * 6.283185307F, a2 = a * a;
  const V sine =
      a * (1.0F + a2 * (-0.16666667F + a2 * (8.3333310e-3F + a2 * (-1.9840874e-4F + a2 * 2.7525562e-6F))));
  const V cosine =
      1.0F +
      a2 * (-0.5F + a2 * (4.1666666e-2F + a2 * (-1.3888889e-3F + a2 * (2.4801587e-5F - a2 * 2.7557319e-7F))));
  const Integers odd = (quarter & 1) != 0;
  const V c = odd ? sine : cosine, s = odd ? cosine : sine;
  return {((quarter + 1) & 2) != 0 ? -c : c, (quarter & 2) != 0 ? -s : s};
}

HWY_INLINE V rootOf(V x) {
  float values[kStepLanes];
  store(x, values);
  for (float& value : values) value = __builtin_sqrtf(value);
  return load(values);
}

/// Calls SmallFourier for 1 .. 16 points.
template <int kSign>
HWY_NOINLINE void fourierOf(Complex<V>* v, int points) {
  switch (points) {
    case 2:
      return SmallFourier<2, kSign, V>::run(v);
    case 4:
      return SmallFourier<4, kSign, V>::run(v);
    case 8:
      return SmallFourier<8, kSign, V>::run(v);
    case 16:
      return SmallFourier<16, kSign, V>::run(v);
    default:
      return;
  }
}

/// BlockShape for an N that is known at run time.
struct Sizes {
  int intervals, columns, lanes, second, third, pitch;

  explicit Sizes(int n)
      : intervals(n),
        columns(n / 8),
        lanes(n / 128),
        second(lanes < 16 ? lanes : 16),
        third(lanes / second),
        pitch(columns + columns / 16) {}
  static int padded(int i) { return i + i / 16; }
  int height(int column, int q) const {
    return q < 8 ? column + columns * q : 2 * intervals - column - columns * q;
  }
};

/// A row of residues to its spectrum, which onSpectrum(butterfly's values, count, index of the first)
/// changes, and back.
template <class OnSpectrum>
HWY_INLINE void transformRow(const Sizes& sizes, StepLanes* row, const LaneTables& tables,
                             const OnSpectrum& onSpectrum) {
  const int lanes = sizes.lanes, second = sizes.second, third = sizes.third;
  const auto at = [row](int i) HWY_ATTR -> StepLanes& { return row[Sizes::padded(i)]; };
  const auto secondBase = [=](int b) { return b / third * lanes + b % third; };
  Complex<V> v[16];
  for (int lane = 0; lane < lanes; ++lane) {
    for (int p = 0; p < 16; ++p) v[p] = load(at(lane + lanes * p));
    fourierOf<1>(v, 16);
    if (lanes == 1) break;
    store(v[0], at(lane));
    for (int a = 1; a < 16; ++a)
      store(v[a] * load(tables.first_turns[a * lanes + lane]), at(lane + lanes * a));
  }
  if (third > 1) {
    for (int b = 0; b < lanes; ++b) {
      for (int p = 0; p < 16; ++p) v[p] = load(at(secondBase(b) + third * p));
      fourierOf<1>(v, 16);
      for (int p = 0; p < 16; ++p) {
        store(v[p] * load(tables.second_turns[p * third + b % third]), at(secondBase(b) + third * p));
      }
    }
  }
  if (lanes == 1) onSpectrum(v, 16, 0);
  const int last = third > 1 ? third : second;
  for (int b = 0; lanes > 1 && b < sizes.columns / last; ++b) {
    for (int p = 0; p < last; ++p) v[p] = load(at(b * last + p));
    fourierOf<1>(v, last);
    onSpectrum(v, last, b * last);
    fourierOf<-1>(v, last);
    for (int p = 0; p < last; ++p) store(v[p], at(b * last + p));
  }
  if (third > 1) {
    for (int b = 0; b < lanes; ++b) {
      for (int p = 0; p < 16; ++p) {
        v[p] = timesConjugate(load(at(secondBase(b) + third * p)),
                              load(tables.second_turns[p * third + b % third]));
      }
      fourierOf<-1>(v, 16);
      for (int p = 0; p < 16; ++p) store(v[p], at(secondBase(b) + third * p));
    }
  }
  for (int lane = 0; lane < lanes; ++lane) {
    if (lanes > 1) {
      v[0] = load(at(lane));
      for (int a = 1; a < 16; ++a) {
        v[a] = timesConjugate(load(at(lane + lanes * a)), load(tables.first_turns[a * lanes + lane]));
      }
    }
    fourierOf<-1>(v, 16);
    for (int p = 0; p < 16; ++p) store(v[p], at(lane + lanes * p));
  }
}

/// @param onSpectrum  (values, count, row, index of the first)
template <class OnSpectrum>
HWY_INLINE void transform(int intervals, StepLanes* field, const LaneTables& tables,
                          const OnSpectrum& onSpectrum) {
  const Sizes sizes(intervals);
  const int columns = sizes.columns, holders = columns / 2 + 1;
  const StepLanes none{};
  Complex<V> v[16];
  for (int t = 0; t < holders; ++t) {
    const bool pair = t > 0 && t < columns / 2;
    const int here = Sizes::padded(t), mirrored = Sizes::padded(columns - t);
    for (int q = 0; q < 16; ++q) {
      const int j = sizes.height(t, q);
      v[q] = load(j == 0 || j == intervals ? none : field[j]);
      if (q >= 8) v[q] = negative(v[q]);
    }
    fourierOf<1>(v, 16);
    store(v[0], tables.rows[here]);
    if (pair) store(negative(v[0]), tables.rows[mirrored]);
    for (int r = 1; r <= 8; ++r) {
      const Complex<float> w = load(tables.column_turns[r * holders + t]);
      StepLanes* const row = tables.rows + r * sizes.pitch;
      store(v[r] * w, row[here]);
      if (pair) store(negative(timesConjugate(v[16 - r], w)), row[mirrored]);
    }
  }
  for (int r = 0; r <= 8; ++r) {
    transformRow(sizes, tables.rows + r * sizes.pitch, tables,
                 [&](Complex<V>* values, int count, int first)
                     HWY_ATTR { onSpectrum(values, count, r, r * columns + first); });
  }
  for (int t = 0; t < holders; ++t) {
    const bool pair = t > 0 && t < columns / 2;
    const int here = Sizes::padded(t), mirrored = Sizes::padded(t == 0 ? 0 : columns - t);
    v[0] = load(tables.rows[here]);
    for (int r = 1; r <= 8; ++r) {
      const Complex<float> w = load(tables.column_turns[r * holders + t]);
      const StepLanes* const row = tables.rows + r * sizes.pitch;
      v[r] = timesConjugate(load(row[here]), w);
      if (r < 8) v[16 - r] = negative(load(row[mirrored]) * w);
    }
    fourierOf<-1>(v, 16);
    for (int q = 0; q < 8; ++q) store(v[q], field[sizes.height(t, q)]);
    for (int q = 8; pair && q < 16; ++q) store(negative(v[q]), field[sizes.height(t, q)]);
  }
  store(Complex<V>{V{}, V{}}, field[0]);
}

/// Adds the powers of some wavenumbers of a row. The rows 0 and 8 hold each wavenumber twice.
HWY_INLINE void addShares(const Complex<V>* values, int count, int row, const int* wavenumbers, int half,
                          LaneTransform::Shares& shares) {
  V sum{}, upper{};
  for (int e = 0; e < count; ++e) {
    const V power = values[e].re * values[e].re + values[e].im * values[e].im;
    sum += power;
    if (wavenumbers[e] >= half) upper += power;
  }
  const double part = row == 0 || row == 8 ? 0.5 : 1.0;
  for (int l = 0; l < kStepLanes; ++l) {
    shares.all[l] += part * double(sum[l]);
    shares.upper[l] += part * double(upper[l]);
  }
}

void stepFlat(int intervals, StepLanes* field, const LaneTables& tables, const StoredComplex* propagator,
              const int* wavenumbers, LaneTransform::Shares* shares) {
  transform(intervals, field, tables, [&](Complex<V>* values, int count, int row, int first) HWY_ATTR {
    if (shares != nullptr) addShares(values, count, row, wavenumbers + first, intervals / 2, *shares);
    for (int e = 0; e < count; ++e) values[e] = values[e] * load(propagator[first + e]);
  });
}

/// See BlockMarch::sloped().
void stepSloped(int intervals, StepLanes* field, const LaneTables& tables, const FlatExponent* exponents,
                const int* wavenumbers, const LaneTransform::Slopes& slopes, float sine_step,
                float wavelengths, LaneTransform::Shares* shares) {
  const V cube = load(slopes.cube), square = load(slopes.square), stretch = load(slopes.stretch);
  transform(intervals, field, tables, [&](Complex<V>* values, int count, int row, int first) HWY_ATTR {
    if (shares != nullptr) addShares(values, count, row, wavenumbers + first, intervals / 2, *shares);
    for (int e = 0; e < count; ++e) {
      const FlatExponent& flat = exponents[first + e];
      const float s = float(wavenumbers[first + e]) * sine_step, squared = s * s, a = flat.cosine;
      const V steep = (1.0F - squared) - squared * square;
      const V b = rootOf(steep > 0.0F ? steep : all(0.0F));
      const V more =
          squared * (cube * (a + 1) * (a + b) + squared * square) / ((a + b) * (a + 1) * (b + 1.0F));
      const V loss = stretch * flat.logarithm;
      const V magnitude = flat.magnitude * (1.0F + loss + 0.5F * loss * loss);
      const Complex<V> turn = unitTurn(flat.turns - more * wavelengths);
      const V kept = steep > 0.0F ? magnitude : all(0.0F);
      values[e] = values[e] * Complex<V>{turn.re * kept, turn.im * kept};
    }
  });
}

void multiplyCommon(StepLanes* field, const StoredComplex* factors, int n) {
  for (int j = 0; j < n; ++j) store(load(field[j]) * load(factors[j]), field[j]);
}
void multiplyEach(StepLanes* field, const StepLanes* factors, int n) {
  for (int j = 0; j < n; ++j) store(load(field[j]) * load(factors[j]), field[j]);
}

void screen(const LaneAir& air, float dz_m, bool wide, const StoredComplex* absorbed, int n, StepLanes* half,
            StepLanes* field) {
  constexpr int kRun = 16;
  const V middle_m = load(air.middle_m), half_turns = load(air.half_turns), stretch = load(air.stretch);
  const V reference = load(air.reference_units), turns = load(air.turns), turns_rest = load(air.turns_rest);
  int level[kStepLanes] = {};
  float next_m[kStepLanes], level_m[kStepLanes], units[kStepLanes], gradient[kStepLanes];
  const auto enter = [&](int l) {
    const int at = level[l];
    level_m[l] = air.level_m[l][at];
    units[l] = air.units[l][at];
    gradient[l] = air.gradient[l][at];
    next_m[l] = at + 1 < air.levels[l] ? air.level_m[l][at + 1] : HUGE_VALF;
  };
  for (int l = 0; l < kStepLanes; ++l) enter(l);
  for (int begin = 0; begin < n; begin += kRun) {
    bool crossing = false;
    for (int l = 0; l < kStepLanes; ++l) {
      crossing |= air.middle_m[l] + float(begin + kRun - 1) * dz_m >= next_m[l];
    }
    V from_m = load(level_m), from = load(units), slope = load(gradient);
    for (int j = begin; j < begin + kRun; ++j) {
      const V z = middle_m + float(j) * dz_m;
      if (crossing) {
        for (int l = 0; l < kStepLanes; ++l) {
          while (z[l] >= next_m[l]) {
            ++level[l];
            enter(l);
          }
        }
        from_m = load(level_m);
        from = load(units);
        slope = load(gradient);
      }
      const V m = (from - reference + slope * (z - from_m)) * 1e-6F;
      const V phase = (wide ? m : m + m * m * 0.5F) * half_turns;
      const V loss = stretch * absorbed[j].im;
      const V magnitude = absorbed[j].re * (1.0F + loss + 0.5F * loss * loss);
      const Complex<V> screened = unitTurn(phase);
      store(Complex<V>{screened.re * magnitude, screened.im * magnitude}, half[j]);
      const V exact = turns * float(j), magic = all(12582912.0F);
      const Complex<V> bent = unitTurn(phase + (exact - ((exact + magic) - magic)) + turns_rest * float(j));
      store(load(field[j]) * Complex<V>{bent.re * magnitude, bent.im * magnitude}, field[j]);
    }
  }
}

void split(const LaneSurface& surface, StepLanes* field, int n, StepLanes* wave) {
  const Complex<float> ratio{surface.ratio.re, surface.ratio.im};
  Complex<V> sum{V{}, V{}}, below{V{}, V{}};
  for (int j = 0; j < n; ++j) {
    const Complex<V> u = load(field[j]);
    sum = sum + u * load(surface.powers[std::size_t(j)]);
    store(u - below * ratio, field[j]);
    below = u;
  }
  store(Complex<V>{V{}, V{}}, field[0]);
  store(sum * Complex<float>{surface.inverse_power.re, surface.inverse_power.im}, *wave);
}

/// Four heights at a time, whose carries differ by one product.
void join(const LaneSurface& surface, StepLanes* field, int n, const StepLanes* wave) {
  const auto power = [&](int i) HWY_ATTR { return load(surface.powers[std::size_t(i)]); };
  Complex<V> held{V{}, V{}}, carry{V{}, V{}};
  for (int j = 0; j < n; ++j) held = held + load(field[j]) * load(surface.weights[std::size_t(j)]);
  const Complex<V> surface_wave = load(*wave) - held;
  for (int j = 0; j < n; j += 4) {
    const Complex<V> a = load(field[j]), b = load(field[j + 1]) + a * power(1),
                     c = load(field[j + 2]) + b * power(1), d = load(field[j + 3]) + c * power(1);
    store(a + carry * power(1) + surface_wave * power(j), field[j]);
    store(b + carry * power(2) + surface_wave * power(j + 1), field[j + 1]);
    store(c + carry * power(3) + surface_wave * power(j + 2), field[j + 2]);
    carry = d + carry * power(4);
    store(carry + surface_wave * power(j + 3), field[j + 3]);
  }
}

void power(const StepLanes* field, int n, float spreading_m2, const float* rise, float dz, bool wide,
           float* to) {
  const V from = load(rise);
  for (int j = 0; j < n; ++j) {
    const Complex<V> u = load(field[j]);
    const V tangent = from + float(j) * dz, slant = wide ? 1.0F + tangent * tangent : all(1.0F);
    store((u.re * u.re + u.im * u.im) * spreading_m2 * slant, to + std::size_t(j) * kStepLanes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emscape::propagation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace emscape::propagation {
namespace {

HWY_EXPORT(stepFlat);
HWY_EXPORT(stepSloped);
HWY_EXPORT(multiplyCommon);
HWY_EXPORT(multiplyEach);
HWY_EXPORT(screen);
HWY_EXPORT(split);
HWY_EXPORT(join);
HWY_EXPORT(power);

StoredComplex turn(double numerator, int denominator) {
  const double angle = 2 * kPi * numerator / denominator;
  return Complex<float>{float(std::cos(angle)), float(std::sin(angle))};
}

}  // namespace

LaneTransform::LaneTransform(int intervals) : intervals_(intervals) {
  withBlockShape<kMaxLaneIntervals>(intervals, [&](auto shape) {
    using Shape = decltype(shape);
    constexpr int L = Shape::kColumns, G = Shape::kLanes,
                  kLast = Shape::kThird > 1 ? Shape::kThird
                          : G > 1           ? Shape::kSecond
                                            : 16;
    for (int i = 0; i < 9 * Shape::kHolders; ++i) {
      column_turns_.push_back(
          turn(double(i / Shape::kHolders) * (i % Shape::kHolders), 2 * Shape::kIntervals));
    }
    for (int i = 0; i < 16 * G; ++i) first_turns_.push_back(turn(double(i / G) * (i % G), L));
    for (int i = 0; i < 16 * Shape::kThird; ++i) {
      second_turns_.push_back(turn(double(i / Shape::kThird) * (i % Shape::kThird), G));
    }
    for (int row = 0; row < Shape::kRows; ++row) {
      for (int b = 0; b < L / kLast; ++b) {
        for (int p = 0; p < kLast; ++p)
          wavenumbers_.push_back(Shape::wavenumber(row, b % G, b / G * kLast + p));
      }
    }
    rows_.resize(std::size_t(Shape::kRows) * Shape::kPitch);
  });
}

LaneTables LaneTransform::tables() {
  return {column_turns_.data(), first_turns_.data(), second_turns_.data(), rows_.data()};
}

void LaneTransform::step(StepLanes* field, const std::vector<StoredComplex>& propagator, Shares* shares) {
  HWY_DYNAMIC_DISPATCH(stepFlat)(intervals_, field, tables(), propagator.data(), wavenumbers_.data(), shares);
}

void LaneTransform::step(StepLanes* field, const std::vector<FlatExponent>& exponents, const Slopes& slopes,
                         float sine_step, float wavelengths, Shares* shares) {
  HWY_DYNAMIC_DISPATCH(stepSloped)
  (intervals_, field, tables(), exponents.data(), wavenumbers_.data(), slopes, sine_step, wavelengths,
   shares);
}

void multiplyLanes(StepLanes* field, const StoredComplex* factors, int n) {
  HWY_DYNAMIC_DISPATCH(multiplyCommon)(field, factors, n);
}

void multiplyLanes(StepLanes* field, const StepLanes* factors, int n) {
  HWY_DYNAMIC_DISPATCH(multiplyEach)(field, factors, n);
}

void screenLanes(const LaneAir& air, float dz_m, bool wide, const StoredComplex* absorbed, int n,
                 StepLanes* half, StepLanes* field) {
  HWY_DYNAMIC_DISPATCH(screen)(air, dz_m, wide, absorbed, n, half, field);
}

void splitLanes(const LaneSurface& surface, StepLanes* field, int n, StepLanes& wave) {
  HWY_DYNAMIC_DISPATCH(split)(surface, field, n, &wave);
}

void joinLanes(const LaneSurface& surface, StepLanes* field, int n, const StepLanes& wave) {
  HWY_DYNAMIC_DISPATCH(join)(surface, field, n, &wave);
}

void powerLanes(const StepLanes* field, int n, float spreading_m2, const float* rise, float dz, bool wide,
                float* power) {
  HWY_DYNAMIC_DISPATCH(power)(field, n, spreading_m2, rise, dz, wide, power);
}

}  // namespace emscape::propagation
#endif
