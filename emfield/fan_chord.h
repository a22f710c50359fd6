/// Positions along the azimuths of a fan: exact at the ends of short chords and linear in latitude and
/// longitude between. Over this length the geodesic deviates from its chord by less than a metre, except near
/// the poles, where the chords are shorter still.
#pragma once

#include <cmath>

#include "emfield/station.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// The chords of one station are consecutive along every azimuth: chord n begins at range n times this (m).
EMSCAPE_HD inline double fanChordLength_m(const Station& station) {
  constexpr double kSineOf80Degrees = 0.984807753012208;
  return std::fabs(station.geodesy.station.up.z) < kSineOf80Degrees ? 800 : 10;
}

EMSCAPE_HD inline int fanChordAt(double range_m, double chord_m) {
  return static_cast<int>(range_m / chord_m);
}

/// One chord.
struct FanChord {
  double begin_m = 0;
  double latitude_rad = 0, longitude_rad = 0;  ///< of its start
  double latitude_slope = 0, longitude_slope = 0;

  /// Terrain height (m) at a range within the chord; NaN if it is missing.
  EMSCAPE_HD float heightAt(const scenario::TerrainView& terrain, double range_m) const {
    const double beyond_m = range_m - begin_m;
    return terrain.heightAt(latitude_rad + beyond_m * latitude_slope,
                            longitude_rad + beyond_m * longitude_slope);
  }
};

/// @param sine, cosine  of the azimuth
EMSCAPE_HD inline FanChord fanChord(const Station& station, double sine, double cosine, int index,
                                    double chord_m) {
  FanChord chord;
  chord.begin_m = index * chord_m;
  const FastDirect from = fastDirect(station.geodesy, sine, cosine, chord.begin_m);
  const FastDirect to = fastDirect(station.geodesy, sine, cosine, chord.begin_m + chord_m);
  chord.latitude_rad = from.latitude_rad;
  chord.longitude_rad = from.longitude_rad;
  chord.latitude_slope = (to.latitude_rad - from.latitude_rad) / chord_m;
  chord.longitude_slope = std::remainder(to.longitude_rad - from.longitude_rad, 2 * kPi) / chord_m;
  return chord;
}

}  // namespace emscape::emfield
