/// What changes from picture to picture of a series besides the field. Internal to the module.
#pragma once

#include <optional>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/view/view_state.h"
#include "emscape/render/scene/camera.h"

namespace emscape::playback {

struct Film {
  std::optional<double> speed;              ///< scenario seconds per second, stated in the pictures
  std::vector<render::CameraSpec> cameras;  ///< one per picture; empty: that of the view
};

/// @param frames_per_s  of a video; none: pictures, which state no speed
/// @throws Error (usage) if the view's camera path needs bookmarks that it does not have
Film filmOf(const ViewState& view, const FrameSource& source, std::optional<double> frames_per_s);

/// The camera on its way from one bookmark to the next: smooth at the bookmarks, bearings along the shorter
/// arc. Of a bookmark that is no orbit, or if only one of two has a distance or target, the next is shown at
/// its time.
/// @param stops  at least one
/// @param at     0: the first, 1: the second, ...
render::CameraSpec cameraOnPath(const std::vector<Bookmark>& stops, double at);

}  // namespace emscape::playback
