/// Radio-climatic zones along a path: ITU-R P.1812-8 section 3.3, P.452-18 section 3.2.1.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

enum class PathZone { sea, coastal_land, inland };

/// Statistics of the zones along a path.
struct PathZones {
  double sea_fraction = 0;              ///< omega, 0..1
  double longest_land_m = 0;            ///< d_tm: coastal land included
  double longest_inland_m = 0;          ///< d_lm
  double coast_distance_m[2] = {0, 0};  ///< d_ct, d_cr: over land to the nearest sea on the path, from either
                                        ///< end; the path's length where there is no sea
  bool ends_at_sea = false;             ///< the receiver
};

/// Accumulates the zones of a path, from the transmitter to the receiver.
class PathZoneSums {
 public:
  EMSCAPE_HD explicit PathZoneSums(double distance_m) : distance_m_(distance_m) {
    zones_.coast_distance_m[0] = distance_m;
  }
  /// Adds the next part of the path.
  EMSCAPE_HD void add(PathZone zone, double begin_m, double end_m) {
    const double length_m = end_m - begin_m;
    zones_.ends_at_sea = zone == PathZone::sea;
    if (zone == PathZone::sea) {
      if (sea_m_ == 0) zones_.coast_distance_m[0] = begin_m;
      sea_m_ += length_m;
      last_sea_m_ = end_m;
      land_m_ = inland_m_ = 0;
      return;
    }
    land_m_ += length_m;
    inland_m_ = zone == PathZone::inland ? inland_m_ + length_m : 0;
    if (land_m_ > zones_.longest_land_m) zones_.longest_land_m = land_m_;
    if (inland_m_ > zones_.longest_inland_m) zones_.longest_inland_m = inland_m_;
  }
  EMSCAPE_HD PathZones zones() const {
    PathZones zones = zones_;
    zones.sea_fraction = sea_m_ / distance_m_;
    zones.coast_distance_m[1] = distance_m_ - last_sea_m_;
    return zones;
  }

 private:
  PathZones zones_;
  double distance_m_;
  double sea_m_ = 0, last_sea_m_ = 0, land_m_ = 0, inland_m_ = 0;
};

/// Zones of a path from those of its posts; the zone of a post extends half way to its neighbours.
/// @param zoneOf  (int) -> zone of a post
template <class ZoneOf>
EMSCAPE_HD PathZones sumZones(const TerrainProfile& profile, ZoneOf zoneOf) {
  const int last = profile.count - 1;
  PathZoneSums sums(profile.range_m[last]);
  double begin_m = 0;
  for (int i = 0; i <= last; ++i) {
    const double end_m = i < last ? (profile.range_m[i] + profile.range_m[i + 1]) / 2 : profile.range_m[last];
    sums.add(zoneOf(i), begin_m, end_m);
    begin_m = end_m;
  }
  return sums.zones();
}

}  // namespace emscape::propagation
