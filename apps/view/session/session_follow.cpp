/// The verb by which the camera follows a platform.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/view/session/session.h"
#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"
#include "playback/pictures/followed_camera.h"

namespace emscape::view {
namespace {

constexpr double kDistance_diagonals = 0.35;  // of a camera that was fitted to the whole box

/// The platform of that name, or of the emitter of that name. @throws Error (bad_input) that lists them
std::string followedPlatform(const scenario::Scenario& scenario, const std::string& name) {
  std::vector<std::string> names;
  for (const scenario::Platform& platform : scenario.platforms) {
    if (platform.name == name) return name;
    names.push_back(platform.name);
  }
  for (const scenario::Emitter& emitter : scenario.emitters) {
    if (emitter.name == name) return scenario.platforms[static_cast<std::size_t>(emitter.platform)].name;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("follow: there is no platform '{}'; there are {}", name, fmt::join(names, ", ")));
}

/// The first platform that moves; else the first.
std::string firstMoving(const scenario::Scenario& scenario) {
  const auto& platforms = scenario.platforms;
  if (platforms.empty()) throw Error(ErrorCode::bad_input, "follow: there are no platforms");
  const auto moving =
      std::find_if(platforms.begin(), platforms.end(),
                   [](const scenario::Platform& platform) { return platform.track.size() > 1; });
  return (moving == platforms.end() ? platforms.begin() : moving)->name;
}

}  // namespace

/// @param name  of a platform or emitter; empty: stops, or follows the first one that moves
/// @param mode  follow, chase, off or empty
void Session::follow(const std::string& name, const std::string& mode) {
  if (mode == "off" || (name.empty() && mode.empty() && !view_.follow.empty())) {
    stopFollowing();
    tell("the camera stays");
    return;
  }
  const playback::ScenarioPtr shown = scenario();
  if (!shown) throw Error(ErrorCode::bad_input, "follow: there is no scenario");
  const std::string platform = !name.empty()          ? followedPlatform(*shown, name)
                               : view_.follow.empty() ? firstMoving(*shown)
                                                      : view_.follow;
  render::CameraSpec camera = camera_.spec();
  if (!camera.distance) camera.distance = kDistance_diagonals;
  camera_.set(camera);
  change([&](playback::ViewState& view) {
    view.follow = platform;
    if (!mode.empty()) view.follow_mode = parseName<playback::FollowMode>("mode", mode);
    view.camera = camera;
  });
  const bool chases = view_.follow_mode == playback::FollowMode::chase;
  tell(fmt::format("the camera {} {}", chases ? "chases" : "follows", platform));
}

void Session::stopFollowing() {
  if (view_.follow.empty()) return;
  if (picture_) {
    camera_.set(playback::followedCamera(view_, picture_->scenario, picture_->terrain, picture_->grid(),
                                         picture_->info().time_s));
  }
  change([&](playback::ViewState& view) {
    view.follow.clear();
    view.camera = camera_.spec();
  });
}

std::vector<Verb> Session::followVerbs() {
  return {
      {"follow",
       {{"name", kText, false}, {"mode", kText, false, {}, {"follow", "chase", "off"}}},
       "The camera looks at a platform, given by its name or that of an emitter on it, as it moves; with "
       "mode "
       "chase it turns with the platform's heading. Without a name: ends, or follows the first platform that "
       "moves",
       [](Session& session, const Command& command) {
         session.follow(command.text("name"), command.text("mode"));
       }}};
}

}  // namespace emscape::view
