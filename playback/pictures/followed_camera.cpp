#include "playback/pictures/followed_camera.h"

#include <algorithm>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::playback {

render::CameraSpec followedCamera(const ViewState& view,
                                  const std::shared_ptr<const scenario::Scenario>& scenario,
                                  const scenario::TerrainPtr& terrain, const volume::Grid& grid,
                                  double time_s) {
  render::CameraSpec spec = view.camera;
  if (view.follow.empty() || !scenario || !grid.georeferenced) return spec;
  const std::vector<scenario::Platform>& platforms = scenario->platforms;
  const auto found =
      std::find_if(platforms.begin(), platforms.end(),
                   [&](const scenario::Platform& platform) { return platform.name == view.follow; });
  if (found == platforms.end()) return spec;
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), time_s);
  const scenario::PlatformState& state =
      snapshot.platforms[static_cast<std::size_t>(found - platforms.begin())];
  spec.target_m = GeoFrame(grid.frame).toLocal(state.position);
  if (view.follow_mode == FollowMode::chase) spec.azimuth_deg += state.attitude.heading_deg;
  return spec;
}

}  // namespace emscape::playback
