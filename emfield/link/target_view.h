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

/// Standard deviation (m/s) of the radial speed of the ground across a radar's beam in the direction of a
/// platform, by the radar's own motion: v cos(elevation) sin(psi) beamwidth / (4 (ln 2)^(1/2)) for a speed v
/// and an azimuth psi from the track, of a Gaussian beam used both ways; the beam of a steered array is wider
/// by the cosines of its steering, as in its clutter. 0 for a radar at rest.
/// @see M. A. Richards, Fundamentals of Radar Signal Processing, section 5.2: a bandwidth of 2 v beamwidth
/// sin(psi) / lambda between the half-power points of one way
double groundSpread_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                        const scenario::Terrain* terrain);

/// Gives a radar's filter what it sees of a target: speedOverGround_mps() and, added to its key's spread,
/// groundSpread_mps().
void aimFilter(const scenario::Snapshot& snapshot, int radar, int platform, const scenario::Terrain* terrain,
               scenario::Clutter& clutter);

/// Number of looks of a radar from the time of its first look until another time.
/// @param period_s  between looks, > 0
long long looksUntil(double first_s, double time_s, double period_s);

}  // namespace emscape::emfield
