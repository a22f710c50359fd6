/// A target as a radar sees it.
#pragma once

#include "emscape/scenario/snapshot.h"
#include "emscape/scenario/target.h"

namespace emscape::emfield {

/// Radar cross section (m2) of a target from where an emitter stands.
double rcsTowards_m2(const scenario::Snapshot& snapshot, const scenario::Target& target, int radar);

/// Speed (m/s) at which a platform moves away from a radar, from the next tenth of a second, at the end of
/// the scenario from the last one.
/// @param terrain  as for instantAt()
double radialSpeed_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                       const scenario::Terrain* terrain);

/// Looks of a radar from a first time, at which it looks, to another.
/// @param period_s  between looks, > 0
long long looksUntil(double first_s, double time_s, double period_s);

}  // namespace emscape::emfield
