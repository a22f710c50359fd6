#include "apps/view/session/platform_drag.h"

#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "emscape/scenario/terrain/terrain.h"
#include "playback/editing/pick.h"

namespace emscape::view {

PlatformDrag::PlatformDrag(const playback::LivePicture& picture, const SceneObject& object, double x,
                           double y)
    : object_(object) {
  const auto index = static_cast<std::size_t>(object.platform);
  if (!picture.scenario || index >= picture.scenario->platforms.size()) {
    throw Error(ErrorCode::bad_input, "there is no scenario to change");
  }
  const scenario::Scenario& scenario = *picture.scenario;
  const scenario::Platform& platform = scenario.platforms[index];
  platform_ = platform.name;
  movesOf(scenario, platform_, 0, 0);  // throws for a platform with a track
  grip_m_ = object.position_m;
  follows_ground_ = platform.track.front().position.height_agl_m && picture.ground && object.height_agl_m;
  if (follows_ground_) grip_m_.z -= *object.height_agl_m;
  const render::Projected grip = render::project(picture.camera, picture.size, picture.box.toDrawn(grip_m_));
  offset_x_ = grip.x - x;
  offset_y_ = grip.y - y;
}

std::optional<std::vector<scenario::Edit>> PlatformDrag::moveTo(const playback::LivePicture& picture,
                                                                double x, double y) {
  const double at_x = x + offset_x_, at_y = y + offset_y_;
  const std::optional<Vec3d> position_m =
      follows_ground_ && picture.ground
          ? playback::pickGround(picture.camera, picture.box, picture.size, at_x, at_y, *picture.ground,
                                 picture.settings.planes)
          : playback::pickLevel(picture.camera, picture.box, picture.size, at_x, at_y, grip_m_.z);
  if (!position_m || !picture.scenario) return std::nullopt;
  const GeodeticPosition position = GeoFrame(picture.grid().frame).toGeodetic(*position_m);
  const double ground_m =
      picture.terrain ? picture.terrain->heightMsl_m(position.latitude_deg, position.longitude_deg) : NAN;
  object_.position.latitude_deg = position.latitude_deg;
  object_.position.longitude_deg = position.longitude_deg;
  if (std::isnan(ground_m)) {
    object_.height_agl_m.reset();
  } else if (follows_ground_) {
    object_.height_msl_m = ground_m + object_.height_agl_m.value_or(0);
  } else {
    object_.height_agl_m = object_.height_msl_m - ground_m;
  }
  return movesOf(*picture.scenario, platform_, position.latitude_deg, position.longitude_deg);
}

}  // namespace emscape::view
