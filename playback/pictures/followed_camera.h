/// The camera of a view that follows a platform.
#pragma once

#include "emscape/playback/view/view_state.h"
#include "emscape/render/scene/camera.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/volume/grid.h"

namespace emscape::playback {

/// The camera of a view at an instant: `view.camera`, at the platform that the view follows and with mode
/// chase turned with its heading; as it is if the view follows none or the grid has no position on the earth.
/// @param scenario, terrain  may be null
render::CameraSpec followedCamera(const ViewState& view,
                                  const std::shared_ptr<const scenario::Scenario>& scenario,
                                  const scenario::TerrainPtr& terrain, const volume::Grid& grid,
                                  double time_s);

}  // namespace emscape::playback
