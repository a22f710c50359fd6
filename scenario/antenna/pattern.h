/// An antenna pattern's amplitude towards a direction: single source for host and device loops.
#pragma once

#include <cmath>
#include <type_traits>

#include "base/math/device_math.h"
#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/scenario/antenna/antenna.h"

namespace emscape::scenario {
namespace antenna_detail {

/// Azimuth and elevation (rad) of a direction (forward, right, up). By arc tangents, which are accurate near
/// boresight.
struct PatternAngles {
  float azimuth_rad;
  float elevation_rad;
};
EMSCAPE_HD inline PatternAngles anglesOf(const Vec3f& direction) {
  const float level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  return {fastAtan2(direction.y, direction.x), fastAtan2(direction.z, level)};
}

/// A position between entries `index` and `index + 1` of a table.
struct TableCell {
  int index;
  float fraction;  ///< 0..1
};
/// The position of x in a uniform table of `count` entries, odd, over -half_span..half_span. Counted from the
/// middle, so that small x keep their precision. Outside the table the last interval is extrapolated; NaN
/// gives any interval of the table.
EMSCAPE_HD inline TableCell cellInTable(float x, float half_span, int count) {
  const int middle = count / 2;
  const float t = x * (static_cast<float>(middle) / half_span);
  // Rounding t - 1/2 is floor(t); at a tie either neighbour is correct, because the interpolation is
  // continuous.
  const int below = static_cast<int>(fast_math_detail::roundToInt(t - 0.5f).as_int);
  const int above_low = below < -middle ? -middle : below;
  const int bounded = above_low > middle - 1 ? middle - 1 : above_low;
  return {bounded + middle, t - static_cast<float>(bounded)};
}
EMSCAPE_HD inline float atCell(const float* table, const TableCell& cell) {
  return lerp(table[cell.index], table[cell.index + 1], cell.fraction);
}
EMSCAPE_HD inline float larger(float a, float b) {
  return a < b ? b : a;
}

/// A table's value with or without its sign; at least a given magnitude.
template <bool kSigned>
EMSCAPE_HD inline float bounded(float value, float smallest) {
  const float magnitude = larger(std::fabs(value), smallest);
  if constexpr (kSigned) return std::copysign(magnitude, value);
  return magnitude;
}

EMSCAPE_HD inline float gaussianAmplitude(const PatternView& pattern, const Vec3f& direction) {
  constexpr float kLog2OfE = 1.44269504f;
  const PatternAngles angles = anglesOf(direction);
  const float exponent = pattern.gaussian_azimuth * angles.azimuth_rad * angles.azimuth_rad +
                         pattern.gaussian_elevation * angles.elevation_rad * angles.elevation_rad;
  return larger(fastExp2(-kLog2OfE * exponent), pattern.side_lobe_amplitude);
}

template <bool kSigned>
EMSCAPE_HD inline float separableAmplitude(const PatternView& pattern, const Vec3f& direction) {
  const PatternAngles angles = anglesOf(direction);
  const TableCell azimuth = cellInTable(angles.azimuth_rad, float(kPi), pattern.azimuth_count);
  const TableCell elevation = cellInTable(angles.elevation_rad, float(kPi / 2), pattern.elevation_count);
  const float product = atCell(pattern.azimuth_table, azimuth) * atCell(pattern.elevation_table, elevation);
  return bounded<kSigned>(product, pattern.side_lobe_amplitude);
}

template <bool kSigned>
EMSCAPE_HD inline float phasedArrayAmplitude(const PatternView& pattern, const Vec3f& direction,
                                             float steer_u, float steer_v) {
  const TableCell u = cellInTable(direction.y - steer_u, 2.0f, pattern.azimuth_count);
  const TableCell v = cellInTable(direction.z - steer_v, 2.0f, pattern.elevation_count);
  const float array = atCell(pattern.azimuth_table, u) * atCell(pattern.elevation_table, v);
  const float element = fastExp2(pattern.element_exponent * fastLog2(direction.x));
  return bounded<kSigned>(direction.x > 0.0f ? array * element : 0.0f, pattern.side_lobe_amplitude);
}

/// The cell of a position counted in entries of a table. NaN gives any interval of the table.
EMSCAPE_HD inline TableCell cellAt(float position, int count) {
  const int below = static_cast<int>(fast_math_detail::roundToInt(position - 0.5f).as_int);
  const int above_low = below < 0 ? 0 : below;
  const int bounded = above_low > count - 2 ? count - 2 : above_low;
  return {bounded, position - static_cast<float>(bounded)};
}

template <bool kRefined>
EMSCAPE_HD inline float gridAmplitude(const PatternView& pattern, const Vec3f& direction) {
  const PatternAngles angles = anglesOf(direction);
  TableCell azimuth =
      cellInTable(angles.azimuth_rad, float(kPi), kRefined ? pattern.azimuth_count : pattern.columns);
  TableCell elevation =
      cellInTable(angles.elevation_rad, float(kPi / 2), kRefined ? pattern.elevation_count : pattern.rows);
  if constexpr (kRefined) {
    azimuth = cellAt(atCell(pattern.azimuth_table, azimuth), pattern.columns);
    elevation = cellAt(atCell(pattern.elevation_table, elevation), pattern.rows);
  }
  // One 32-bit index instead of one offset pointer per lane, so that the look-ups become gathers.
  const int corner = elevation.index * pattern.columns + azimuth.index;
  const int above = corner + pattern.columns;
  const float* table = pattern.grid_table;
  const float value =
      std::fabs(lerp(lerp(table[corner], table[corner + 1], azimuth.fraction),
                     lerp(table[above], table[above + 1], azimuth.fraction), elevation.fraction));
  return larger(value, pattern.side_lobe_amplitude);
}

}  // namespace antenna_detail

/// >= 0 if the amplitude in a direction (forward, right, up; of any length) may exceed side_lobe_amplitude.
/// For patterns whose lobe_tangent is not 0.
EMSCAPE_HD inline float depthInLobe(const PatternView& pattern, const Vec3f& direction) {
  return pattern.lobe_tangent * direction.x - std::fabs(direction.y);
}

/// patternAmplitude() of a kind known at compile time, for loops: without branches; `#pragma omp simd`
/// vectorises it (see base/math/fast_math.h for the flags).
/// @tparam kSigned  true: with the sign of the field, which changes from lobe to lobe of apertures and arrays
template <PatternKind kind, bool kSigned = false>
EMSCAPE_HD inline float amplitudeOf(const PatternView& pattern, const Vec3f& direction, float steer_u,
                                    float steer_v) {
  if constexpr (kind == PatternKind::gaussian) {
    return antenna_detail::gaussianAmplitude(pattern, direction);
  } else if constexpr (kind == PatternKind::separable) {
    return antenna_detail::separableAmplitude<kSigned>(pattern, direction);
  } else if constexpr (kind == PatternKind::phased_array) {
    return antenna_detail::phasedArrayAmplitude<kSigned>(pattern, direction, steer_u, steer_v);
  } else if constexpr (kind == PatternKind::grid) {
    return antenna_detail::gridAmplitude<false>(pattern, direction);
  } else if constexpr (kind == PatternKind::refined_grid) {
    return antenna_detail::gridAmplitude<true>(pattern, direction);
  } else {
    return 1.0f;
  }
}

/// Calls f(kind) with a pattern's kind as a std::integral_constant, so that f may use it as a template
/// argument.
#if defined(__CUDACC__)
#pragma nv_exec_check_disable
#endif
template <class Function>
EMSCAPE_HD inline auto onPattern(const PatternView& pattern, const Function& f) {
  switch (pattern.kind) {
    case PatternKind::gaussian:
      return f(std::integral_constant<PatternKind, PatternKind::gaussian>{});
    case PatternKind::separable:
      return f(std::integral_constant<PatternKind, PatternKind::separable>{});
    case PatternKind::phased_array:
      return f(std::integral_constant<PatternKind, PatternKind::phased_array>{});
    case PatternKind::grid:
      return f(std::integral_constant<PatternKind, PatternKind::grid>{});
    case PatternKind::refined_grid:
      return f(std::integral_constant<PatternKind, PatternKind::refined_grid>{});
    case PatternKind::isotropic:
      break;
  }
  return f(std::integral_constant<PatternKind, PatternKind::isotropic>{});
}

/// Amplitude (relative voltage, 0..1) towards a direction of the antenna's frame.
/// @param direction  (forward, right, up), a unit vector for phased_array, of any length above 0 for the
/// other kinds; a
///                   NaN in it gives any value of the pattern or NaN
/// @param steer_u, steer_v  phased_array: the direction cosines (right, up) to which the array is steered;
/// else ignored
/// @accuracy for beamwidths of 1 degree and more, down to 40 dB below the maximum: gaussian within 1e-4 dB of
/// the closed form; phased_array and separable within 1e-3 dB (3e-3 dB next to the corner of a
/// cosecant-squared pattern)
EMSCAPE_HD inline float patternAmplitude(const PatternView& pattern, const Vec3f& direction, float steer_u,
                                         float steer_v) {
  return onPattern(pattern,
                   [&](auto kind) { return amplitudeOf<kind>(pattern, direction, steer_u, steer_v); });
}

}  // namespace emscape::scenario
