/// Dragging of a platform in the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/view/tools/scene_objects.h"
#include "emscape/scenario/model/edit.h"
#include "playback/live/live_view.h"

namespace emscape::view {

/// Starts a drag. A platform whose height is given above the ground follows the ground under the cursor; any
/// other platform keeps its height. The cursor keeps its distance from the marker.
class PlatformDrag {
 public:
  /// @param object  on the platform
  /// @throws Error (bad_input) if the picture has no scenario, or the platform moves along a track
  PlatformDrag(const playback::LivePicture& picture, const SceneObject& object, double x, double y);

  /// The object where moveTo() has last moved it.
  const SceneObject& object() const { return object_; }
  /// The edits that move the platform to the cursor; empty if there is no position under it.
  std::optional<std::vector<scenario::Edit>> moveTo(const playback::LivePicture& picture, double x, double y);

 private:
  std::string platform_;
  SceneObject object_;
  bool follows_ground_ = false;
  Vec3d grip_m_;  // the point under the cursor, at its height
  double offset_x_ = 0, offset_y_ = 0;
};

}  // namespace emscape::view
