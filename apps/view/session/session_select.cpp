/// Verbs of the selection.
#include <algorithm>

#include "apps/view/session/session.h"
#include "apps/view/values/position_text.h"
#include "emscape/base/error.h"
#include "playback/editing/pick.h"

namespace emscape::view {

std::string Session::selected() const {
  const playback::ScenarioPtr shown = scenario();
  return shown && hasItem(*shown, selected_) ? selected_ : std::string();
}

const std::vector<SceneObject>& Session::objects() const {
  if (picture_ && objects_of_ != picture_) {
    const bool is_same = objects_of_ && objects_of_->scenario == picture_->scenario &&
                         objects_of_->info().time_s == picture_->info().time_s &&
                         objects_of_->grid() == picture_->grid();
    if (!is_same) objects_ = sceneObjectsOf(*picture_);
    findPixels(objects_, *picture_);
    objects_of_ = picture_;
  }
  return objects_;
}

const SceneObject* Session::objectOf(const std::string& path) const {
  const std::vector<SceneObject>& all = objects();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SceneObject& object) { return object.path == path; });
  return found == all.end() ? nullptr : &*found;
}

/// @throws Error (bad_input) if there is no such object in the picture
const SceneObject& Session::requireObject(const std::string& path) const {
  if (const SceneObject* object = objectOf(path)) return *object;
  throw Error(ErrorCode::bad_input,
              path.empty() ? "nothing is selected" : "there is no '" + path + "' in the picture");
}

void Session::select(const std::string& path) {
  if (!path.empty() && !(scenario() && hasItem(*scenario(), path))) {
    throw Error(ErrorCode::bad_input, "select: there is no '" + path +
                                          "'; expected emitters.NAME, platforms.NAME, receivers.NAME or "
                                          "targets.NAME");
  }
  selected_ = path;
}

/// Selects the object after or before the selected one, in the order of objects().
void Session::selectNext(int change) {
  const std::vector<SceneObject>& all = objects();
  if (all.empty()) throw Error(ErrorCode::bad_input, "select: the picture has nothing to select");
  const auto count = static_cast<int>(all.size());
  const SceneObject* const object = objectOf(selected());
  const int index = object != nullptr ? static_cast<int>(object - all.data()) : (change > 0 ? -1 : 0);
  selected_ = all[static_cast<std::size_t>((index + change + count) % count)].path;
}

/// The ground under a pixel of the picture, or without a ground the bottom of the box.
std::optional<Vec3d> Session::groundAt(double x, double y) const {
  const playback::LivePicture& picture = *picture_;
  return picture.ground
             ? playback::pickGround(picture.camera, picture.box, picture.size, x, y, *picture.ground,
                                    picture.settings.planes)
             : playback::pickLevel(picture.camera, picture.box, picture.size, x, y, picture.box.lower_m.z);
}

void Session::copyText(const std::string& text) {
  window_.setClipboard(text);
  copied_ = text;
  tell("copied: " + text);
}

Json Session::selectionReport() const {
  static const char* const kTools[] = {"none", "measure", "track", "place"};
  Json report{{"selected", selected()}, {"tool", kTools[static_cast<std::size_t>(tool_.kind)]}};
  if (const SceneObject* object = picture_ ? objectOf(selected()) : nullptr) {
    const render::Projected at =
        render::project(picture_->camera, picture_->size, picture_->box.toDrawn(object->position_m));
    report["selected_x"] = at.x;
    report["selected_y"] = at.y;
  }
  if (tool_.measurement) {
    report["measured_m"] = tool_.measurement->distance_m;
    report["measured_bearing_deg"] = tool_.measurement->bearing_deg;
    report["measured_in_sight"] = !tool_.measurement->is_blocked;
  }
  const ProbeResult* const under = cursor_.isOver() ? cursor_.result() : nullptr;
  if (under != nullptr && under->reading && under->reading->position) {
    report["cursor_latitude_deg"] = under->reading->position->latitude_deg;
    report["cursor_longitude_deg"] = under->reading->position->longitude_deg;
    report["cursor_text"] = under->reading->text;
  }
  return report;
}

std::vector<Verb> Session::selectionVerbs() {
  return {
      {"select",
       {{"path", kText, false}, {"change", kNumber, false, {-1, 1, true, true}}},
       "Selects an emitter, platform, receiver or target by its path, such as emitters.jammer; or `change`, "
       "1 "
       "or -1: the next or previous one; without arguments nothing is selected",
       [](Session& session, const Command& command) {
         if (command.has("change")) return session.selectNext(static_cast<int>(command.number("change")));
         session.select(command.text("path"));
       }},
      {"copy_position",
       {{"path", kText, false}, {"x", kNumber, false}, {"y", kNumber, false}},
       "Puts a position on the clipboard: of an emitter, platform, receiver or target, or of the ground "
       "under "
       "a pixel of the picture; default: of what is selected",
       [](Session& session, const Command& command) {
         if (!session.picture_) throw Error(ErrorCode::bad_input, "there is no picture yet");
         if (command.has("x") && command.has("y")) {
           const auto ground_m = session.groundAt(command.number("x"), command.number("y"));
           if (!ground_m || !session.picture_->grid().georeferenced)
             throw Error(ErrorCode::bad_input, "copy_position: there is no ground");
           const GeoFrame frame(session.picture_->grid().frame);
           return session.copyText(positionText(frame.toGeodetic(*ground_m), session.view_));
         }
         const std::string path = command.has("path") ? command.text("path") : session.selected();
         session.copyText(positionText(session.requireObject(path).position, session.view_));
       }},
  };
}

}  // namespace emscape::view
