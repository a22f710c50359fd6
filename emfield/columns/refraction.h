/// Refraction by an atmosphere whose refractivity falls exponentially with height.
///
/// Models with an effective earth of radius k a are valid in the lowest kilometres, where refractivity is
/// nearly linear in height. Here the height of a point is replaced by the height on the effective earth that
/// the ray would reach with its curvature near the ground: the paths of rays near the ground, and their
/// horizons, are unchanged.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

/// Placed before a loop that must not be unrolled on the device, to save registers in kernels that rarely
/// need it.
#if defined(__CUDA_ARCH__)
#define EMSCAPE_ROLLED _Pragma("unroll 1")
#else
#define EMSCAPE_ROLLED
#endif

namespace emscape::emfield {

/// Heights below 3 km are unchanged, so that masts keep their heights above the terrain.
///
/// Plain data. Without `exponential` all heights are unchanged.
struct Refraction {
  bool exponential = false;
  double earth_radius_m = 0;
  double effective_earth_radius_m = 0;
  double gradient_per_m = 0;  ///< -dn/dh at sea level
  double decay_per_m = 0;     ///< of refractivity over height

  static constexpr int kNodes = 33;
  static constexpr float kHighest_m = 100e3f;
  static constexpr double kLinear_m = 3e3, kExponential_m = 10e3;
  /// Height on the effective earth with the same horizon, divided by the height, at heights equally spaced in
  /// their square root up to kHighest_m.
  float grazing_ratio[kNodes] = {};

  /// Mean (1/m) of the curvature along a ray, weighted by the remaining distance: at the far end the ray from
  /// the lower end is this value times `distance_m` squared below the straight line. Computed in two
  /// iterations of the ray's path.
  /// @param distance_m  along the ground
  EMSCAPE_HD double bending(double from_m, double to_m, double distance_m) const {
    constexpr int kSteps = 16;
    constexpr double kStep = 1.0 / kSteps;
    const double square_m2 = distance_m * distance_m;
    double drop[kSteps + 1];  // below the straight line, over square_m2
    EMSCAPE_ROLLED
    for (int i = 0; i <= kSteps; ++i) {
      const double t = i * kStep;
      drop[i] = t * (1 - t) / 2 * (1 / earth_radius_m - 1 / effective_earth_radius_m);
    }
    double mean = 0;
    EMSCAPE_ROLLED
    for (int pass = 0; pass < 2; ++pass) {
      double density[kSteps + 1];
      mean = 0;
      EMSCAPE_ROLLED
      for (int i = 0; i <= kSteps; ++i) {
        const double t = i * kStep;
        const double height_m =
            from_m + t * (to_m - from_m) + square_m2 * (drop[i] - t * (1 - t) / (2 * earth_radius_m));
        density[i] = gradient_per_m * std::exp(-decay_per_m * (height_m > 0 ? height_m : 0));
        mean += (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * (1 - t) * density[i];
      }
      mean *= kStep / 3;
      double slope = 0, fallen = 0;  // integrals of the density, once and twice
      double fall[kSteps + 1] = {};
      EMSCAPE_ROLLED
      for (int i = 1; i <= kSteps; ++i) {
        fallen += kStep * (slope + kStep * (2 * density[i - 1] + density[i]) / 6);
        slope += kStep * (density[i - 1] + density[i]) / 2;
        fall[i] = fallen;
      }
      EMSCAPE_ROLLED
      for (int i = 0; i <= kSteps; ++i) drop[i] = i * kStep * fallen - fall[i];
    }
    return mean;
  }

  /// Height (m) on the effective earth of a ray with the launch angle of the ray from a low to a high point.
  EMSCAPE_HD double imageHeight_m(double low_m, double high_m, double distance_m) const {
    const double more =
        bending(low_m, high_m, distance_m) - (1 / earth_radius_m - 1 / effective_earth_radius_m) / 2;
    const double rise_m = (high_m - low_m) / (1 + high_m / earth_radius_m) + distance_m * distance_m * more;
    return (low_m + rise_m) / (1 - rise_m / effective_earth_radius_m);
  }

  /// Range (m) of the horizon of a height on the effective earth.
  EMSCAPE_HD double horizon_m(double image_m) const {
    if (!(image_m > 0)) return 0;
    const double radius_m = effective_earth_radius_m;
    return radius_m * std::atan(std::sqrt(image_m * (2 * radius_m + image_m)) / radius_m);
  }

  /// Weight (0..1) of a height's correction: 0 below kLinear_m, where the linear refractivity is equally
  /// accurate and heights must match those of the terrain; 1 from kExponential_m on.
  static EMSCAPE_HD double correctedPart(double height_msl_m) {
    const double t = (height_msl_m - kLinear_m) / (kExponential_m - kLinear_m);
    return t < 0 ? 0 : t > 1 ? 1 : t * t * (3 - 2 * t);
  }

  /// Height (m) on the effective earth with the same horizon as a height.
  EMSCAPE_HD double grazingHeight_m(double height_msl_m) const {
    if (!exponential || !(height_msl_m > kLinear_m)) return height_msl_m;
    const double position = std::sqrt(height_msl_m / double(kHighest_m)) * (kNodes - 1);
    const int below = position < kNodes - 2 ? static_cast<int>(position) : kNodes - 2;
    const double part = position < kNodes - 1 ? position - below : 1;
    const double ratio =
        double(grazing_ratio[below]) + part * double(grazing_ratio[below + 1] - grazing_ratio[below]);
    return height_msl_m * (1 + correctedPart(height_msl_m) * (ratio - 1));
  }

  /// Height (m) on the effective earth of a point that is seen from a station.
  /// @param range_m  along the ground
  /// @accuracy of points above 10 km, seen from below 3 km: horizons within 0.1 %, rays within 20 m at 500 km
  EMSCAPE_HD double effectiveHeight_m(double height_msl_m, double station_msl_m, double range_m) const {
    if (!exponential || !(range_m > 0) || !(height_msl_m > kLinear_m)) return height_msl_m;
    // The image must be exact at the lowest point of the ray, or at the ground that it grazes.
    const double radius_m = effective_earth_radius_m;
    double begin_m = range_m / 2 - radius_m * (height_msl_m - station_msl_m) / range_m;
    begin_m = begin_m < 0 ? 0 : begin_m > range_m ? range_m : begin_m;
    const double t = begin_m / range_m;
    double low_m =
        station_msl_m + (height_msl_m - station_msl_m) * t - begin_m * (range_m - begin_m) / (2 * radius_m);
    const double horizon = horizon_m(grazingHeight_m(height_msl_m));
    double distance_m = range_m - begin_m;
    if (low_m < 0 && begin_m > 0) low_m = 0;
    if (distance_m > horizon) distance_m = horizon;
    const double image_m = imageHeight_m(low_m, height_msl_m, distance_m);
    return height_msl_m + correctedPart(height_msl_m) * (image_m - height_msl_m);
  }

  /// The inverse: the point's height above mean sea level.
  EMSCAPE_HD double heightOfImage_m(double image_m, double station_msl_m, double range_m) const {
    double height_m = image_m;
    if (!exponential) return height_m;
    constexpr int kIterations = 24;
    EMSCAPE_ROLLED
    for (int i = 0; i < kIterations; ++i) {
      const double step_m = image_m - effectiveHeight_m(height_m, station_msl_m, range_m);
      height_m += step_m;
      if (std::abs(step_m) < 0.01) break;
    }
    return height_m;
  }
};

}  // namespace emscape::emfield
