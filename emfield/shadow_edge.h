/// The edge of the shadow in one column, from the grazing slopes of a fan; for host and device.
#pragma once

#include <cmath>

#include "base/device_math.h"
#include "emfield/fan_coordinates.h"
#include "emfield/terrain_fan.h"
#include "emscape/base/host_device.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {

using propagation::HorizonGeometry;
using propagation::RangeTerms;

template <class Real>
EMSCAPE_HD HorizonGeometry<Real> horizonGeometry(const Station& station) {
  return {Real(station.height_msl_m), Real(station.effective_earth_radius_m)};
}

/// Grazing slopes of some neighbouring intervals of a fan.
struct SlopePlanes {
  HorizonGeometry<float> geometry;
  FanView fan;
  int first_interval = 0;
  const float* slopes = nullptr;  ///< of the first interval's first azimuth
  long long azimuth_stride = 0, range_stride = 0;

  /// Height above mean sea level (m) of the shadow's edge over a point of the ground: voxels at or above it
  /// are lit. -infinity: nothing is in shadow; +infinity: all is; NaN: unknown, because the path crosses
  /// missing terrain.
  /// @param azimuth_index  of the fan, within the intervals
  EMSCAPE_HD float edgeHeight_m(double azimuth_index, double range_m) const {
    if (range_m > fan.ranges_m[fan.range_count - 1]) return HUGE_VALF;
    const int interval = static_cast<int>(azimuth_index);
    const float weight = static_cast<float>(azimuth_index - interval);
    const int before = fan.lastBefore(range_m);
    if (before == 0) return -HUGE_VALF;
    const RangeTerms<float> terms = geometry.termsAt(range_m);
    const float* slope = slopes + (interval - first_interval) * azimuth_stride + before * range_stride;
    const float left = geometry.heightOn(slope[0], terms);
    const float right = geometry.heightOn(slope[azimuth_stride], terms);
    return lerp(left, right, weight);
  }
};

/// z of the edge in a tilted column: the layers are tested from the top down.
/// @param planes  of all intervals
/// @param t_m     z of the layers
EMSCAPE_HD inline float edgeInLeaningColumn(const Station& station, const SlopePlanes& planes,
                                            const GridColumn& column, const float* t_m, int layers) {
  float above_m = HUGE_VALF;
  for (int k = layers - 1; k >= 0; --k) {
    const FanCoordinates point = fanCoordinates(station, column, t_m[k]);
    const float edge_m = planes.edgeHeight_m(planes.fan.azimuthIndex(point.azimuth_rad), point.range_m);
    if (std::isnan(edge_m)) return edge_m;
    if (!(heightMsl_m(column, t_m[k]) >= edge_m)) return above_m;
    above_m = t_m[k];
  }
  return -HUGE_VALF;
}

}  // namespace emscape::emfield
