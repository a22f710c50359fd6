/// Attenuation by gases and rain along a path, added to any model's excess.
#pragma once

#include <cmath>
#include <vector>

#include "emscape/base/host_device.h"
#include "propagation/inputs.h"

namespace emscape::propagation {

/// Paths from one emitter through the air, as plain data.
///
/// Gases: their mean specific attenuation along the ray, which is straight over the effective earth, in a
/// table over ground range and height, and the path's length. Rain: the same everywhere from the ground up
/// to a height; its part of the ray is exact.
/// @accuracy gases within 0.2 % of an integral along the ray (or 1e-3 dB), for regions up to 20 km high
struct AirLoss {
  float station_msl_m = 0;
  float earth_radius_m = 0, effective_earth_radius_m = 0;

  /// dB/m, range_count x height_count, height fastest; null: no gases.
  const float* gases = nullptr;
  int range_count = 0, height_count = 0;
  float ranges_per_m = 0;
  float lowest_msl_m = 0, heights_per_m = 0;

  /// Specific attenuation (dB/m) of rain along level and upright rays; 0: no rain.
  float level_rain = 0, upright_rain = 0;
  float rain_top_msl_m = 0;

  EMSCAPE_HD bool isClear() const { return gases == nullptr && level_rain == 0; }

  /// @param range_m  along the ground
  EMSCAPE_HD float lossDb(float range_m, float height_msl_m) const {
    const float length_m = slantRange_m(range_m, height_msl_m);
    float loss_db = 0;
    if (gases != nullptr) loss_db += length_m * meanGases(range_m, height_msl_m);
    if (level_rain > 0) {
      const float rise = (height_msl_m - station_msl_m) / (length_m > 1 ? length_m : 1.0f);
      const float upright = rise * rise < 1 ? rise * rise : 1.0f;
      loss_db += length_m * partBelowRainTop(range_m, height_msl_m) *
                 (level_rain + upright * (upright_rain - level_rain));
    }
    return loss_db;
  }

  /// Straight distance (m).
  EMSCAPE_HD float slantRange_m(float range_m, float height_msl_m) const {
    const float rise_m = height_msl_m - station_msl_m;
    const float chord_m = 2 * earth_radius_m * std::sin(range_m / (2 * earth_radius_m));
    return std::sqrt(rise_m * rise_m + chord_m * chord_m * (1 + station_msl_m / earth_radius_m) *
                                           (1 + height_msl_m / earth_radius_m));
  }

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

 private:
  EMSCAPE_HD float meanGases(float range_m, float height_msl_m) const {
    const auto place = [](float position, int count, int& index) {
      const float last = static_cast<float>(count - 1);
      position = position < 0 ? 0.0f : position > last ? last : position;
      index = static_cast<int>(position) < count - 2 ? static_cast<int>(position) : count - 2;
      return position - static_cast<float>(index);
    };
    int r = 0, h = 0;
    const float in_range = place(range_m * ranges_per_m, range_count, r);
    const float in_height = place((height_msl_m - lowest_msl_m) * heights_per_m, height_count, h);
    const float* const near_row = gases + r * height_count + h;
    const float* const far_row = near_row + height_count;
    const float near_value = near_row[0] + in_height * (near_row[1] - near_row[0]);
    const float far_value = far_row[0] + in_height * (far_row[1] - far_row[0]);
    return near_value + in_range * (far_value - near_value);
  }
};

/// Height (m above mean sea level) up to which it rains, in the mean year.
/// @see ITU-R P.839-2, by latitude; later editions have maps
double rainHeight_m(double latitude_deg);

/// Attenuation by the air on an emitter's paths.
/// @param with_gases  true: adds the gases; rain is always added
/// @param gases       receives the table that the result points to
AirLoss airLoss(const PathInputs& inputs, bool with_gases, std::vector<float>& gases);

}  // namespace emscape::propagation
