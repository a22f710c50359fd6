/// The power density of jammers at a radar, each along its own path.
#pragma once

#include <string>
#include <vector>

#include "emfield/channels/radar_share.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// The active jammers of a snapshot at a radar, each along its own path by its own propagation model. Those
/// on the radar's own platform are left out: coupling between antennas of one platform is not modelled.
/// @param terrain  null: none in the scenario
/// @param warning receives a message if a path crosses missing terrain, which is then assumed to be
/// unobstructed; null: it is an error
/// @param duration_s  > 0: also those that radiate at some time of it, from the snapshot's on
/// @throws Error (bad_input) for missing terrain, see warning
std::vector<JammerPath> jammerPaths(const scenario::Snapshot& snapshot, int radar,
                                    const std::vector<int>& jammers, const scenario::Terrain* terrain,
                                    std::string* warning, double duration_s = 0);

}  // namespace emscape::emfield
