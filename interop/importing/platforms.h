/// Platforms of a scenario and their track files.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/terrain/terrain.h"
#include "interop/importing/nodes.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// What was raised because it was below the ground, and where no ground is known.
struct Raised {
  long long positions = 0;
  double deepest_m = 0;
  long long without_ground = 0;
};

/// Poses within a window and one more at each side; raised by a height, and to 2 m above the ground where
/// they are below it.
/// @param terrain  null: the ground is at mean sea level
std::vector<PoseSample> trackOf(const RecordedObject& object, const TimeSpan& window, double raise_m,
                                const scenario::Terrain* terrain, Raised& raised);

/// True if an object does not move or turn.
bool isFixed(const std::vector<PoseSample>& track);

/// A track file.
std::string trackCsv(const std::vector<PoseSample>& track);

/// @param track_file  name of its track file, relative to the scenario; empty: fixed at the first pose
DocumentNodePtr platformNode(const std::string& name, Side side, const PoseSample& pose,
                             const std::string& track_file);

/// The region around tracks: square voxels, a margin, and a top above the highest position.
/// @throws Error (bad_input) if it would be larger than a scenario's region may be
DocumentNodePtr regionAround(const std::vector<std::vector<PoseSample>>& tracks);
DocumentNodePtr regionOf(double latitude_deg, double longitude_deg, double size_m,
                         const std::vector<std::vector<PoseSample>>& tracks);

}  // namespace emscape::interop
