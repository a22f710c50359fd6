/// Verbs of the camera and its bookmarks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/session/session.h"
#include "base/geodesy/position_text.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "playback/editing/pick.h"
#include "scenario/model/named_items.h"

namespace emscape::view {
namespace {

constexpr double kFocus_diagonals = 0.45;  // distance of the target

constexpr NumberLimits kTurn_deg{-36000, 36000};
constexpr NumberLimits kShift_px{-1e5, 1e5};
constexpr NumberLimits kBookmark{1, 9, true};

int bookmarkNumber(const Command& command) {
  return static_cast<int>(command.number("number"));
}

}  // namespace

void Session::focusEmitter(const std::optional<std::string>& name) {
  const std::size_t count = objects().empty() ? 0 : picture_->scenario->emitters.size();
  if (count == 0) throw Error(ErrorCode::bad_input, "focus: the picture has no emitters");
  const std::size_t index =
      name ? scenario::indexOfNamed(picture_->scenario->emitters, *name, "emitter") : focused_ % count;
  focused_ = index + 1;
  focusObject(objects()[index]);
}

void Session::focusObject(const SceneObject& object) {
  stopFollowing();
  camera_.focus(object.position_m, kFocus_diagonals, *viewport());
  cameraMoved();
  tell(object.name);
}

void Session::focusGround(double x, double y) {
  const std::optional<Vec3d> ground_m = groundAt(x, y);
  if (!ground_m) return;
  stopFollowing();
  camera_.focus(*ground_m, std::min(kFocus_diagonals, camera_.spec().distance.value_or(kFocus_diagonals)),
                *viewport());
  cameraMoved();
}

void Session::focusPosition(const std::string& text) {
  const playback::LivePicture& picture = *picture_;
  if (!picture.grid().georeferenced)
    throw Error(ErrorCode::bad_input, "goto_position: the volume has no position on the earth");
  const ParsedPosition position = parsePosition(text);
  Vec3d target_m = GeoFrame(picture.grid().frame).toLocal({position.latitude_deg, position.longitude_deg, 0});
  const Vec3d &lower = picture.box.lower_m, &upper = picture.box.upper_m;
  if (!(target_m.x >= lower.x && target_m.x <= upper.x && target_m.y >= lower.y && target_m.y <= upper.y)) {
    throw Error(ErrorCode::bad_input,
                positionText(position.latitude_deg, position.longitude_deg, view_.positions) +
                    " is outside of the volume");
  }
  const double ground_m = picture.ground ? heightAt_m(*picture.ground, target_m.x, target_m.y) : lower.z;
  target_m.z = std::isnan(ground_m) ? lower.z : std::max(ground_m, lower.z);
  stopFollowing();
  camera_.focus(target_m, std::min(kFocus_diagonals, camera_.spec().distance.value_or(kFocus_diagonals)),
                *viewport());
  cameraMoved();
  tell(positionText(position.latitude_deg, position.longitude_deg, view_.positions));
}

std::vector<Verb> Session::cameraVerbs() {
  return {
      {"orbit",
       {{"azimuth_deg", kNumber, false, kTurn_deg}, {"elevation_deg", kNumber, false, kTurn_deg}},
       "Turns the camera about its target by these angles",
       [](Session& session, const Command& command) {
         const std::optional<Viewport> view = session.viewport();
         if (!view) return;
         session.camera_.orbit(command.number("azimuth_deg"), command.number("elevation_deg"), *view);
         session.cameraMoved();
       }},
      {"pan",
       {{"right_px", kNumber, true, kShift_px}, {"down_px", kNumber, true, kShift_px}},
       "Moves the scene with the cursor",
       [](Session& session, const Command& command) {
         const std::optional<Viewport> view = session.viewport();
         if (!view) return;
         session.stopFollowing();
         session.camera_.pan(command.number("right_px"), command.number("down_px"), *view);
         session.cameraMoved();
       }},
      {"dolly",
       {{"factor", kNumber, true, {1e-3, 1e3}}},
       "Multiplies the distance to the target, 0.001..1000",
       [](Session& session, const Command& command) {
         const std::optional<Viewport> view = session.viewport();
         if (!view) return;
         session.camera_.dolly(command.number("factor"), view->size.width / 2.0, view->size.height / 2.0,
                               *view);
         session.cameraMoved();
       }},
      {"camera",
       {{"spec", kText, true, {}, {}, [](const std::string& text) { render::parseCamera(text); }}},
       "Sets the camera, as `emscape render --camera` does",
       [](Session& session, const Command& command) {
         session.stopFollowing();
         session.camera_.set(render::parseCamera(command.text("spec")));
         session.cameraMoved();
       }},
      {"projection",
       {{"projection", kText, false, {}, {"perspective", "orthographic"}}},
       "perspective or orthographic, at the same scale; without a name the other one",
       [](Session& session, const Command& command) {
         const std::optional<Viewport> view = session.viewport();
         if (!view) return;
         const bool was_orthographic = session.camera_.spec().projection == render::Projection::orthographic;
         const bool is_orthographic =
             command.has("projection") ? command.text("projection") == "orthographic" : !was_orthographic;
         session.camera_.setProjection(
             is_orthographic ? render::Projection::orthographic : render::Projection::perspective, *view);
         session.cameraMoved();
       }},
      {"reset_view",
       {},
       "Back to the camera of the start",
       [](Session& session, const Command&) {
         session.stopFollowing();
         session.camera_.set(session.options_.view.camera);
         session.cameraMoved();
       }},
      {"focus",
       {{"emitter", kText, false}, {"path", kText, false}, {"x", kNumber, false}, {"y", kNumber, false}},
       "Looks at an emitter, at what has a path such as platforms.ridge, or at the ground under a pixel of "
       "the picture; without arguments at the next emitter",
       [](Session& session, const Command& command) {
         if (command.has("x") != command.has("y") ||
             command.has("x") + command.has("emitter") + command.has("path") > 1)
           throw Error(ErrorCode::bad_input, "focus: expected x and y, emitter, or path");
         if (!session.picture_) return;
         if (command.has("path")) return session.focusObject(session.requireObject(command.text("path")));
         if (command.has("x")) {
           session.focusGround(command.number("x"), command.number("y"));
         } else {
           session.focusEmitter(command.has("emitter") ? std::optional(command.text("emitter"))
                                                       : std::nullopt);
         }
       }},
      {"goto_position",
       {{"position", kText, true, {}, {}, [](const std::string& text) { parsePosition(text); }}},
       "Looks at the ground at a position: decimal degrees, degrees with minutes and seconds, UTM or MGRS",
       [](Session& session, const Command& command) {
         if (session.picture_) session.focusPosition(command.text("position"));
       }},
      {"bookmark",
       {{"number", kNumber, true, kBookmark}},
       "Stores camera and time under a number, 1..9",
       [](Session& session, const Command& command) {
         const int number = bookmarkNumber(command);
         const std::optional<Viewport> viewport = session.viewport();
         const render::CameraSpec camera =
             viewport ? session.camera_.settledSpec(*viewport) : session.camera_.spec();
         session.bookmarks_[static_cast<std::size_t>(number - 1)] =
             playback::Bookmark{std::to_string(number), camera, session.timeline_.asked_s()};
         session.tell(fmt::format("bookmark {} stored", number));
       }},
      {"recall",
       {{"number", kNumber, true, kBookmark}},
       "Shows a bookmark",
       [](Session& session, const Command& command) {
         const int number = bookmarkNumber(command);
         if (!session.bookmarks_[static_cast<std::size_t>(number - 1)]) {
           throw Error(ErrorCode::bad_input,
                       fmt::format("bookmark {} is empty: Ctrl+{} stores it", number, number));
         }
         const playback::Bookmark& stored = *session.bookmarks_[static_cast<std::size_t>(number - 1)];
         session.stopFollowing();
         session.camera_.set(stored.camera);
         session.cameraMoved();
         if (stored.time_s) session.timeline_.seek(*stored.time_s);
         session.askTime();
       }},
  };
}

}  // namespace emscape::view
