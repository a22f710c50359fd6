/// Poses of platforms that a program states itself: hosts that move platforms, live exercises.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::scenario {

/// Position and attitude of a platform, in place of its site or track.
struct PlatformPose {
  int platform = -1;  ///< index into Scenario::platforms
  SitePosition position;
  Attitude attitude;
  bool is_present = true;  ///< false: it was there last; its emitters are silent
};

/// A position at a height above mean sea level, and above ground.
SitePosition positionMsl(double latitude_deg, double longitude_deg, double height_msl_m);
SitePosition positionAgl(double latitude_deg, double longitude_deg, double height_agl_m);

/// Index of the platform with a name. @throws Error (bad_input) if there is none
int platformNamed(const Scenario& scenario, const std::string& name);

/// A copy of a scenario with platforms as fixed sites at the poses; of several poses of one platform the last
/// one counts. The poses are not in the scenario's text: set() loses them.
/// @throws Error (usage) for a platform that the scenario does not have, and for a position, height or angle
/// out of its range
std::shared_ptr<const Scenario> withPoses(const Scenario& scenario, const std::vector<PlatformPose>& poses);

/// The snapshot of withPoses(), without the copy.
/// @throws as snapshotAt() and withPoses()
Snapshot snapshotAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s,
                    const std::vector<PlatformPose>& poses);

}  // namespace emscape::scenario
