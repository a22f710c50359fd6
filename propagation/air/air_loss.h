/// Attenuation by gases and rain along a path, added to any model's excess.
#pragma once

#include <cmath>
#include <vector>

#include "base/math/float_pair.h"
#include "emscape/base/host_device.h"
#include "propagation/inputs.h"

namespace emscape::propagation {

/// Atmospheric losses of the paths from one emitter, as plain data.
///
/// Gases: the mean specific attenuation along the ray, which is straight over the effective earth, is
/// tabulated over ground range and height, and multiplied by the path's length. Rain: uniform from the ground
/// up to a height; the part of the ray in rain is exact.
/// @accuracy gases within 0.2 % of an integral along the ray (or 1e-3 dB), for regions up to 20 km high
struct AirLoss {
  float station_msl_m = 0;
  float earth_radius_m = 0, effective_earth_radius_m = 0;

  /// dB/m, range_count x height_count, height fastest; null: no gases.
  const float* gases = nullptr;
  int range_count = 0, height_count = 0;
  float ranges_per_m = 0;
  float lowest_msl_m = 0, heights_per_m = 0;

  /// Specific attenuation (dB/m) of rain along horizontal and vertical rays; 0: no rain.
  float level_rain = 0, upright_rain = 0;
  float rain_top_msl_m = 0;

  EMSCAPE_HD bool isClear() const { return gases == nullptr && level_rain == 0; }

  /// @param range_m  along the ground
  EMSCAPE_HD float lossDb(float range_m, float height_msl_m) const;

  /// Fraction (0..1) of the ray below the top of the rain. The ray's height over the range is a parabola.
  EMSCAPE_HD float partBelowRainTop(float range_m, float height_msl_m) const {
    const float below_m = rain_top_msl_m - station_msl_m;
    if (range_m < 1) {
      const float rise_m = height_msl_m - station_msl_m;
      if (rise_m == 0) return below_m >= 0 ? 1.0f : 0.0f;
      const float part = below_m / rise_m;
      const float within = part < 0 ? 0.0f : part > 1 ? 1.0f : part;
      return rise_m > 0 ? within : 1 - within;
    }
    const float curvature = 1 / effective_earth_radius_m;
    const float slope = (height_msl_m - station_msl_m) / range_m - range_m * curvature / 2;
    const float discriminant = slope * slope + 2 * below_m * curvature;
    if (discriminant <= 0) return 0;
    // Roots of below = slope x + curvature x^2 / 2, each in the form without cancellation.
    const float root = std::sqrt(discriminant);
    const float near_m = slope > 0 ? -(slope + root) / curvature : 2 * below_m / (slope - root);
    const float far_m = slope > 0 ? 2 * below_m / (slope + root) : (root - slope) / curvature;
    const auto within = [range_m](float x_m) { return x_m < 0 ? 0.0f : x_m > range_m ? range_m : x_m; };
    return (within(far_m) - within(near_m)) / range_m;
  }
};

/// The paths to the points above one position.
class AirColumn {
 public:
  /// @param air      must outlive this object
  /// @param range_m  along the ground
  EMSCAPE_HD AirColumn(const AirLoss& air, float range_m) : air_(air), range_m_(range_m) {
    const float chord_m = 2 * air.earth_radius_m * std::sin(range_m / (2 * air.earth_radius_m));
    per_radius_m_ = 1 / air.earth_radius_m;
    chord2_m2_ = chord_m * chord_m * (1 + air.station_msl_m * per_radius_m_);
    if (air.gases == nullptr) return;
    int near = 0;
    in_range_ = place(range_m * air.ranges_per_m, air.range_count, near);
    near_row_ = air.gases + near * air.height_count;
  }

  EMSCAPE_HD float lossDb(float height_msl_m) const {
    float loss_db = air_.gases != nullptr ? gasesDb(height_msl_m) : 0;
    if (air_.level_rain > 0) {
      const float length_m = slantRange_m(height_msl_m);
      const float rise = (height_msl_m - air_.station_msl_m) / (length_m > 1 ? length_m : 1.0f);
      const float upright = rise * rise < 1 ? rise * rise : 1.0f;
      loss_db += length_m * air_.partBelowRainTop(range_m_, height_msl_m) *
                 (air_.level_rain + upright * (air_.upright_rain - air_.level_rain));
    }
    return loss_db;
  }

  /// Of gases alone, where there is a table of them.
  EMSCAPE_HD float gasesDb(float height_msl_m) const {
    return slantRange_m(height_msl_m) * meanGases(height_msl_m);
  }

  /// Straight distance (m).
  EMSCAPE_HD float slantRange_m(float height_msl_m) const {
    const float rise_m = height_msl_m - air_.station_msl_m;
    return std::sqrt(rise_m * rise_m + chord2_m2_ * (1 + height_msl_m * per_radius_m_));
  }

 private:
  /// Splits a position among `count` nodes into the node below and the fraction beyond it.
  static EMSCAPE_HD float place(float position, int count, int& node) {
    const float last = static_cast<float>(count - 1);
    position = position < 0 ? 0.0f : position > last ? last : position;
    node = static_cast<int>(position) < count - 2 ? static_cast<int>(position) : count - 2;
    return position - static_cast<float>(node);
  }
  EMSCAPE_HD float meanGases(float height_msl_m) const {
    int h = 0;
    const float in_height =
        place((height_msl_m - air_.lowest_msl_m) * air_.heights_per_m, air_.height_count, h);
    // Indices instead of pointers per lane, so that the look-ups become gathers.
    const FloatPair near = floatPair(near_row_ + h), far = floatPair(near_row_ + air_.height_count + h);
    const float near_value = near.first + in_height * (near.second - near.first);
    const float far_value = far.first + in_height * (far.second - far.first);
    return near_value + in_range_ * (far_value - near_value);
  }

  const AirLoss& air_;
  float range_m_, per_radius_m_, chord2_m2_;
  const float* near_row_ = nullptr;  ///< of air_.gases
  float in_range_ = 0;
};

EMSCAPE_HD inline float AirLoss::lossDb(float range_m, float height_msl_m) const {
  return AirColumn(*this, range_m).lossDb(height_msl_m);
}

/// Height (m above mean sea level) of the top of the rain, in the mean year.
/// @see ITU-R P.839-2, by latitude; later editions have maps
double rainHeight_m(double latitude_deg);

/// Atmospheric attenuation on an emitter's paths.
/// @param with_gases  true: adds the gases; rain is always added
/// @param gases       receives the table to which the result points
/// @throws Error (bad_input) with gases if a height of the extent is not finite
AirLoss airLoss(const PathInputs& inputs, bool with_gases, std::vector<float>& gases);

}  // namespace emscape::propagation
