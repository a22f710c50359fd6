/// Heights of a fan: at a point, and as the profile up to it.
#pragma once

#include <cstddef>

#include "base/device_math.h"
#include "emfield/terrain_fan.h"
#include "emscape/base/host_device.h"
#include "propagation/column.h"

namespace emscape::emfield {

using propagation::ExcessScratch;
using propagation::TerrainProfile;

/// Height at any range up to a fan's last, linear between its samples.
/// @param heightOf  height (m) of a sample
template <class HeightOf>
EMSCAPE_HD float heightBetween(const FanView& shape, double range_m, HeightOf heightOf) {
  const int before = shape.lastBefore(range_m);
  const int after = before + 1 < shape.range_count ? before + 1 : before;
  const float low = heightOf(before);
  if (after == before) return low;
  const double part = (range_m - shape.ranges_m[before]) / (shape.ranges_m[after] - shape.ranges_m[before]);
  return lerp(low, heightOf(after), static_cast<float>(part));
}

/// Heights of some of a fan's intervals, as plain data.
struct FanHeights {
  FanView shape;
  const float* height_msl_m = nullptr;  ///< as TerrainFan::height_msl_m
  int first_interval = 0;
  int interval_count = 0;

  EMSCAPE_HD bool holds(double azimuth_index) const {
    return azimuth_index >= first_interval && azimuth_index < first_interval + interval_count;
  }
  /// Height at a sample's range, linear between the azimuths.
  EMSCAPE_HD float heightAt(double azimuth_index, int range) const {
    const int interval = static_cast<int>(azimuth_index);
    const float weight = static_cast<float>(azimuth_index - interval);
    const float* left =
        height_msl_m + static_cast<std::size_t>(interval - first_interval) * shape.range_count + range;
    const float right = left[shape.range_count];
    return lerp(*left, right, weight);
  }
  /// The same at any range up to the last.
  EMSCAPE_HD float heightAt(double azimuth_index, double range_m) const {
    return heightBetween(shape, range_m, [&](int range) { return heightAt(azimuth_index, range); });
  }
};

/// The profile to a point of the ground: the fan's samples nearer than it, linear between the azimuths, and
/// the point itself. Every column has its own profile, so that there are no seams between azimuths.
EMSCAPE_HD inline TerrainProfile readProfile(const FanHeights& fan, double azimuth_index, double range_m,
                                             float ground_msl_m, const ExcessScratch& scratch) {
  const int before = fan.shape.lastBefore(range_m);
  const int interval = static_cast<int>(azimuth_index);
  const float weight = static_cast<float>(azimuth_index - interval);
  const float* left =
      fan.height_msl_m + static_cast<std::size_t>(interval - fan.first_interval) * fan.shape.range_count;
  const float* right = left + fan.shape.range_count;
  for (int i = 0; i <= before; ++i) {
    scratch.range_m[i] = fan.shape.ranges_m[i];
    scratch.ground_msl_m[i] = left[i] + weight * (right[i] - left[i]);
  }
  const bool beyond_first = range_m > fan.shape.ranges_m[0];
  const int last = beyond_first ? before + 1 : 0;
  if (beyond_first) {
    scratch.range_m[last] = range_m;
    scratch.ground_msl_m[last] = ground_msl_m;
  }
  return {scratch.range_m, scratch.ground_msl_m, last + 1};
}

}  // namespace emscape::emfield
