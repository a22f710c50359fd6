/// Zones and clutter along a path, from an emitter's settings and the heights of the terrain.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/propagation/settings.h"
#include "propagation/clear_air/zones.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

/// Max height of coastal land above the sea, and max distance from it.
constexpr float kCoastalHeight_m = 100;
constexpr double kCoastalDistance_m = 50e3;

/// Zones by the land cover and the terrain's heights: TerrainProfile::isSea(); land up to kCoastalHeight_m
/// high and within kCoastalDistance_m of a sea post of the path is coastal land; the rest is inland.
EMSCAPE_HD inline PathZones zonesByHeight(const TerrainProfile& profile) {
  int has_sea = 0;
  for (int i = 0; i < profile.count; ++i) has_sea |= profile.isSea(i) ? 1 : 0;
  if (has_sea == 0) {
    const double length_m = profile.range_m[profile.count - 1];
    PathZoneSums sums(length_m);
    sums.add(PathZone::inland, 0, length_m);
    return sums.zones();
  }
  int next_sea = 0;
  double last_sea_m = -2 * kCoastalDistance_m;
  return sumZones(profile, [&](int i) {
    const auto isSea = [&](int post) { return profile.isSea(post); };
    const double range_m = profile.range_m[i];
    if (isSea(i)) {
      last_sea_m = range_m;
      return PathZone::sea;
    }
    if (profile.height_msl_m[i] > kCoastalHeight_m) return PathZone::inland;
    if (range_m - last_sea_m <= kCoastalDistance_m) return PathZone::coastal_land;
    next_sea = next_sea > i ? next_sea : i;
    while (next_sea < profile.count && profile.range_m[next_sea] - range_m <= kCoastalDistance_m) {
      if (isSea(next_sea)) return PathZone::coastal_land;
      ++next_sea;
    }
    return PathZone::inland;
  });
}

/// Zones of a path by the setting.
EMSCAPE_HD inline PathZones zonesOf(ClearAirZone setting, const TerrainProfile& profile) {
  if (setting == ClearAirZone::by_height) return zonesByHeight(profile);
  const double length_m = profile.range_m[profile.count - 1];
  PathZoneSums sums(length_m);
  sums.add(setting == ClearAirZone::sea            ? PathZone::sea
           : setting == ClearAirZone::coastal_land ? PathZone::coastal_land
                                                   : PathZone::inland,
           0, length_m);
  return sums.zones();
}

/// True if a post is within a distance of either end of a path.
EMSCAPE_HD inline bool isNearTerminal(const TerrainProfile& profile, int post, double distance_m) {
  const double range_m = profile.range_m[post], least_m = distance_m - 1e-3;  // but for rounding
  return range_m < least_m || profile.range_m[profile.count - 1] - range_m < least_m;
}

/// Zone setting and clutter of the paths of an emitter.
struct ClearAirGround {
  ClearAirZone zone = ClearAirZone::by_height;
  float clutter_height_m = 0;     ///< on land of unknown cover
  double clutter_distance_m = 0;  ///< min distance of clutter from either antenna

  /// False if there is none on a profile.
  EMSCAPE_HD bool hasClutter(const TerrainProfile& profile) const {
    return profile.cover_m != nullptr || clutter_height_m != 0;
  }
  EMSCAPE_HD float clutterAt(const TerrainProfile& profile, int post) const {
    const bool is_sea = zone == ClearAirZone::sea || (zone == ClearAirZone::by_height && profile.isSea(post));
    return is_sea || isNearTerminal(profile, post, clutter_distance_m)
               ? 0
               : profile.clutter_m(post, clutter_height_m);
  }
};

}  // namespace emscape::propagation
