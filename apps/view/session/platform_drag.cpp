#include "apps/view/session/platform_drag.h"

#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "playback/editing/pick.h"
#include "scenario/file/named_items.h"

namespace emscape::view {

std::optional<std::size_t> markerAt(const playback::LivePicture& picture, double x, double y) {
  constexpr double kReach_px = 14;
  std::optional<std::size_t> nearest;
  double nearest_px = kReach_px;
  for (std::size_t i = 0; i < picture.annotations.markers.size(); ++i) {
    const render::Marker& marker = picture.annotations.markers[i];
    if (!marker.is_shown) continue;
    const render::Projected at =
        render::project(picture.camera, picture.size, picture.box.toDrawn(marker.position_m));
    const double away_px = std::hypot(at.x - x, at.y - y);
    if (!at.in_front || away_px > nearest_px) continue;
    nearest = i;
    nearest_px = away_px;
  }
  return nearest;
}

PlatformDrag::PlatformDrag(const playback::LivePicture& picture, std::size_t index, double x, double y) {
  const std::vector<render::Marker>& markers = picture.annotations.markers;
  if (!picture.scenario || index >= markers.size())
    throw Error(ErrorCode::bad_input, "there is no scenario to change");
  const scenario::Scenario& scenario = *picture.scenario;
  const render::Marker& marker = markers[index];
  // The markers of emitters are followed by those of platforms without emitters.
  const std::size_t carrier = index < scenario.emitters.size()
                                  ? static_cast<std::size_t>(scenario.emitters[index].platform)
                                  : scenario::indexOfNamed(scenario.platforms, marker.label, "platform");
  const scenario::Platform& platform = scenario.platforms[carrier];
  platform_ = platform.name;
  movesOf(scenario, platform_, 0, 0);  // throws for a platform with a track
  grip_m_ = marker.position_m;
  follows_ground_ = platform.track.front().position.height_agl_m && picture.ground && marker.ground_m;
  if (follows_ground_) grip_m_.z = *marker.ground_m;
  const render::Projected grip = render::project(picture.camera, picture.size, picture.box.toDrawn(grip_m_));
  offset_x_ = grip.x - x;
  offset_y_ = grip.y - y;
}

std::optional<std::vector<scenario::Edit>> PlatformDrag::moveTo(const playback::LivePicture& picture,
                                                                double x, double y) const {
  const double at_x = x + offset_x_, at_y = y + offset_y_;
  const std::optional<Vec3d> position_m =
      follows_ground_ && picture.ground
          ? playback::pickGround(picture.camera, picture.box, picture.size, at_x, at_y, *picture.ground,
                                 picture.settings.planes)
          : playback::pickLevel(picture.camera, picture.box, picture.size, at_x, at_y, grip_m_.z);
  if (!position_m || !picture.scenario) return std::nullopt;
  const GeodeticPosition position = GeoFrame(picture.grid().frame).toGeodetic(*position_m);
  return movesOf(*picture.scenario, platform_, position.latitude_deg, position.longitude_deg);
}

}  // namespace emscape::view
