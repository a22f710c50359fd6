/// Edits that add, copy, rename and move the items of a scenario. Values are common ones, to be changed
/// afterwards.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// What can be added: radar, transmitter, jammer, platform, receiver, target.
const std::vector<std::string>& itemKinds();

/// A position on the ground (degrees, WGS84).
struct GroundPosition {
  double latitude_deg = 0, longitude_deg = 0;
};

struct NewItem {
  std::string kind;      ///< one of itemKinds()
  std::string name;      ///< empty: one that is not used
  std::string platform;  ///< of all but platforms; empty: the first one, or a new one at `position`
  std::optional<GroundPosition> position;  ///< of the new platform; a platform without one: the origin
};

/// @throws Error (bad_input) for a platform or position that does not exist or does not apply
std::vector<Edit> editsToAdd(const Scenario& scenario, const NewItem& item);

/// A copy of an emitter, platform, receiver or target.
/// @param path  "emitters.jammer"
/// @param name  of the copy; empty: one that is not used
/// @throws Error (bad_input) if there is no such item
Edit editToDuplicate(const Scenario& scenario, const std::string& path, const std::string& name);

/// An edit and, if it gives an item another name, the edits of the values that contain the name.
std::vector<Edit> editsWithReferences(const Scenario& scenario, const Edit& edit);

/// @throws Error (bad_input) if there is no such item, or other items are on the platform
Edit editToRemove(const Scenario& scenario, const std::string& path);

/// A point of a drawn track.
struct DrawnPoint {
  GroundPosition position;
  std::optional<double> height_agl_m;  ///< none: the height of the platform's first point, as it is given
};

/// The edits that let a platform move along points. The speed is constant.
/// @param points   at least two
/// @param begin_s  when it is at the first point
/// @param speed_mps  none: it arrives at the end of the scenario
/// @throws Error (bad_input)
std::vector<Edit> editsForTrack(const Scenario& scenario, const std::string& platform,
                                const std::vector<DrawnPoint>& points, double begin_s,
                                std::optional<double> speed_mps);

}  // namespace emscape::scenario
