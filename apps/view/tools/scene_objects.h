/// The things of a scenario that can be selected in a picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/live/live_view.h"
#include "render/annotate/marker_places.h"

namespace emscape::view {

/// An emitter, placed receiver, target or platform, where it is at the picture's time.
struct SceneObject {
  std::string path;  ///< "emitters.search radar", of edits
  std::string name;
  std::string kind;     ///< "radar", "receiver", ...
  std::string details;  ///< frequency and power of an emitter, "absent at this time"; may be empty
  int platform = -1;    ///< index into Scenario::platforms
  bool present = true;  ///< false: the position is the nearer end of its track, or the last one known
  Vec3d position_m;     ///< frame metres
  GeodeticPosition position;
  double height_msl_m = 0;
  std::optional<double> height_agl_m;  ///< none if the ground is not known
  /// By findPixels(): its symbol in the picture; without one the mouse does not find it.
  std::optional<render::MarkerPlace> pixel;
};

/// All of them: emitters in the scenario's order, then receivers, targets and platforms. Empty without a
/// scenario, and for a picture that has no position on the earth.
std::vector<SceneObject> sceneObjectsOf(const playback::LivePicture& picture);
/// Sets where they are in a picture of their time.
void findPixels(std::vector<SceneObject>& objects, const playback::LivePicture& picture);

/// The object under a pixel of the picture: that of the nearest symbol within some pixels, of those with one
/// symbol the first. @return null if there is none
const SceneObject* objectAt(const std::vector<SceneObject>& objects, double x, double y);

/// True if a scenario has an item with a path: "emitters.NAME", "platforms.NAME", "receivers.NAME" or
/// "targets.NAME".
bool hasItem(const scenario::Scenario& scenario, const std::string& path);

}  // namespace emscape::view
