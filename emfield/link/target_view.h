/// Cross section and radial speed of a target for a radar.
#pragma once

#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/model/target.h"

namespace emscape::emfield {

/// Radar cross section (m2) of a target in the direction of an emitter.
double rcsTowards_m2(const scenario::Snapshot& snapshot, const scenario::Target& target, int radar);

/// Speed (m/s) at which a platform moves away from a radar: the central difference over 20 ms, without the
/// part beyond a point of a track, where the speed steps; at such a point that of the leg that begins there,
/// at the end of a track that of the last leg.
/// @param terrain  as for instantAt()
double radialSpeed_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                       const scenario::Terrain* terrain);

/// The same without the radar's own motion: what a filter sees of the target, whose zero is the ground in its
/// direction. The ground there moves away at radialSpeed_mps() less this: for a radar of speed v at the angle
/// psi from its track, -v cos psi. @see M. A. Richards, Fundamentals of Radar Signal Processing, section 5.2
double speedOverGround_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                           const scenario::Terrain* terrain);

/// Number of looks of a radar from the time of its first look until another time.
/// @param period_s  between looks, > 0
long long looksUntil(double first_s, double time_s, double period_s);

}  // namespace emscape::emfield
