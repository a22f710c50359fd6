/// What jammers send into radars' antennas.
#pragma once

#include <string>
#include <vector>

#include "emfield/radar_product.h"
#include "emfield/terrain_fan.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/snapshot.h"

namespace emscape::emfield {

/// A jammer as a radar receives it.
struct JammerInSight {
  int jammer = 0;  ///< index of the emitter
  /// Unit vector from the radar along the start of the refracted ray to the jammer, east-north-up.
  Vec3d direction;
  double power_density_wm2 = 0;  ///< at the radar: with the jammer's antenna, propagation model and losses
};

/// The active jammers of a snapshot at a radar, each along its own path by its own propagation model.
/// @param terrain  null: none in the scenario
/// @param warning  where a path crosses missing terrain, it is counted as free and told here; null: it is an
/// error
/// @throws Error (bad_input) for missing terrain, see warning
std::vector<JammerInSight> jammersInSight(const scenario::Snapshot& snapshot, int radar,
                                          const std::vector<int>& jammers, const scenario::Terrain* terrain,
                                          const FanResolution& resolution, std::string* warning);

/// A radar's part in a channel at one instant.
/// @param task     as the channel's recipe has it
/// @param jammers  that count in the channel
RadarShare radarShare(const scenario::Scenario& scenario, int radar, const scenario::EmitterState& state,
                      const RadarTask& task, const std::vector<JammerInSight>& jammers);

}  // namespace emscape::emfield
