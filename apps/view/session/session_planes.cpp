/// Verbs of comparison, cutting planes and the map layer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/session/plane_drag.h"
#include "apps/view/session/session.h"
#include "base/text/shell_word.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

using render::CutPlane;

CutPlane::Kind kindOf(const std::string& name) {
  return name == "horizontal" ? CutPlane::Kind::horizontal : CutPlane::Kind::vertical;
}

/// @throws Error (bad_input) if there are too many
void requireRoom(const std::vector<CutPlane>& planes) {
  if (planes.size() < static_cast<std::size_t>(render::kMaxCutPlanes)) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("plane: there are {} already, which is the most", planes.size()));
}

/// The plane that a command names by number, otherwise the last one.
std::size_t indexOf(const Command& command, const std::vector<CutPlane>& planes) {
  if (planes.empty())
    throw Error(ErrorCode::bad_input, "plane: there is no plane; `spec` or `kind` adds one");
  const auto number = static_cast<std::size_t>(command.number("index", static_cast<double>(planes.size())));
  if (number <= planes.size()) return number - 1;
  throw Error(ErrorCode::bad_input, fmt::format("plane: index {}: expected 1..{}", number, planes.size()));
}

/// Applies the values of a command to a plane.
void changeValues(CutPlane& plane, const Command& command) {
  const bool horizontal = plane.kind == CutPlane::Kind::horizontal;
  const std::vector<const char*> of_the_other =
      horizontal ? std::vector<const char*>{"bearing_deg", "offset_m", "cuts_ground"}
                 : std::vector<const char*>{"altitude_m"};
  for (const char* name : of_the_other) {
    if (!command.has(name)) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("plane: a {} plane has no {}", horizontal ? "horizontal" : "vertical", name));
  }
  plane.altitude_m = command.number("altitude_m", plane.altitude_m);
  plane.bearing_deg = command.number("bearing_deg", plane.bearing_deg);
  plane.offset_m = command.number("offset_m", plane.offset_m);
  plane.cuts_ground = command.boolean("cuts_ground", plane.cuts_ground);
  plane.on = command.boolean("on", plane.on);
  if (command.boolean("flip", false)) plane = render::flipped(plane);
}

}  // namespace

CutPlane Session::newPlane(CutPlane::Kind kind) const {
  CutPlane plane;
  plane.kind = kind;
  plane.cuts_ground = false;
  if (kind == CutPlane::Kind::vertical) {
    // Along the picture, so that the section faces the viewer.
    plane.bearing_deg = std::fmod(camera_.spec().azimuth_deg + 630, 360);
    plane.keep = CutPlane::Side::left;
    return plane;
  }
  if (picture_) {
    const double low = picture_->box.lower_m.z, high = picture_->box.upper_m.z;
    plane.altitude_m = roundedPosition(0.5 * (low + high), high - low);
  }
  return plane;
}

void Session::setPlanes(const std::vector<CutPlane>& planes) {
  render::checkCutPlanes(planes);
  if (planes == planes_.state()) return;
  planes_.set(planes);
  showPlanes();
}

void Session::dragPlanes(const std::vector<CutPlane>& planes) {
  if (planes_.dragged() == nullptr) planes_.beginDrag();
  setPlanes(planes);
}

void Session::endPlaneDrag() {
  planes_.endDrag();
  noteSteps();
}

void Session::showPlanes() {
  change([&](playback::ViewState& view) { view.settings.planes = planes_.state(); });
}

void Session::switchPlanes(const Command& command) {
  std::vector<CutPlane> planes = view_.settings.planes;
  const auto isOn = [](const CutPlane& plane) { return plane.on; };
  if (command.has("kind")) {
    const CutPlane::Kind kind = kindOf(command.text("kind"));
    const auto found = std::find_if(planes.begin(), planes.end(),
                                    [kind](const CutPlane& plane) { return plane.kind == kind; });
    if (found != planes.end()) {
      found->on = !found->on;
    } else {
      requireRoom(planes);
      planes.push_back(newPlane(kind));
    }
  } else {
    const bool on = std::none_of(planes.begin(), planes.end(), isOn);
    for (CutPlane& plane : planes) plane.on = on;
  }
  setPlanes(planes);
  const bool cuts = std::any_of(planes.begin(), planes.end(), isOn);
  if (cuts) panels.planes = true;  // where they are moved
}

void Session::changePlane(const Command& command) {
  std::vector<CutPlane> planes = view_.settings.planes;
  if (command.has("spec")) {
    const CutPlane plane = render::parseCutPlane(command.text("spec"));
    if (command.has("index")) {
      planes[indexOf(command, planes)] = plane;
    } else {
      requireRoom(planes);
      planes.push_back(plane);
    }
  } else {
    const std::size_t index = indexOf(command, planes);
    if (command.boolean("remove", false)) {
      planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(index));
    } else {
      changeValues(planes[index], command);
    }
  }
  setPlanes(planes);
}

void Session::changeMapLayer(const Command& command) {
  const bool is_on = view_.settings.map_height_agl_m.has_value();
  const bool turns_on =
      command.boolean("on", command.has("height_agl_m") || (command.has("opacity") ? is_on : !is_on));
  if (is_on) last_map_height_agl_m_ = *view_.settings.map_height_agl_m;
  last_map_height_agl_m_ = command.number("height_agl_m", last_map_height_agl_m_);
  change([&](playback::ViewState& view) {
    view.settings.map_height_agl_m = turns_on ? std::optional(last_map_height_agl_m_) : std::nullopt;
    view.settings.map_opacity = command.number("opacity", view.settings.map_opacity);
  });
  if (turns_on && picture_ && !picture_->ground) tell("no ground is drawn: nothing is painted on it");
}

void Session::requireReference(const char* verb) const {
  if (!showsFiles() || !options_.view.compare.empty()) return;
  throw Error(
      ErrorCode::bad_input,
      fmt::format("{}: volumes have no original; `emscape view {} --compare FILE` compares them with others",
                  verb, shellWord(view_.input)));
}

void Session::changeComparison(bool compares) {
  if (compares == this->compares()) return;
  if (compares) requireReference("compare");
  leaveField();
  const std::string& first = options_.view.compare;
  const std::string reference = first.empty() ? playback::kOriginal : first;
  change([&](playback::ViewState& view) {
    playback::changeSplit(view, 0);
    playback::changeComparison(view, compares ? reference : std::string());
  });
  const bool is_of_itself = reference == playback::kOriginal && viewState().edits.empty();
  if (compares && is_of_itself) tell("nothing is changed: no difference");
}

void Session::changeSplit(double split) {
  if (picture_ && picture_->cells)
    throw Error(ErrorCode::bad_input, "split: fields on tetrahedra are not drawn side by side");
  const std::string& first = options_.view.compare;
  if (split > 0) requireReference("split");
  const bool was_difference = compares();
  const std::string field = fieldName(chosenQuantity());
  if (split > 0) last_split_ = split;
  change([&](playback::ViewState& view) {
    if (split > 0 && view.compare.empty() && !first.empty()) playback::changeComparison(view, first);
    playback::changeSplit(view, split);
    if (split <= 0) playback::changeComparison(view, "");
  });
  if (was_difference != compares()) leaveField(field);
}

void Session::moveSplit(double x) {
  if (!picture_ || picture_->size.width < 2) return;
  constexpr double kMargin = 0.02;
  changeSplit(std::clamp(x / picture_->size.width, kMargin, 1 - kMargin));
}

std::vector<Verb> Session::planeVerbs() {
  const render::SettingLimits &height = render::kMapHeightLimits, &opacity = render::kMapOpacityLimits;
  return {
      {"map_layer",
       {{"height_agl_m", kNumber, false, {height.min, height.max}},
        {"opacity", kNumber, false, {opacity.min, opacity.max}},
        {"on", kBoolean, false}},
       "Paints the values at a height above the ground on it; nothing: on or off, at the last height",
       [](Session& session, const Command& command) { session.changeMapLayer(command); }},
      {"plane",
       {{"spec", kText, false, {}, {}, [](const std::string& text) { render::parseCutPlane(text); }},
        {"kind", kText, false, {}, {"horizontal", "vertical"}},
        {"index", kNumber, false, {1, render::kMaxCutPlanes, true}},
        {"altitude_m", kNumber, false},
        {"bearing_deg", kNumber, false},
        {"offset_m", kNumber, false},
        {"cuts_ground", kBoolean, false},
        {"flip", kBoolean, false},
        {"on", kBoolean, false},
        {"remove", kBoolean, false}},
       "Cutting planes: `spec`, as for --plane, adds one or replaces that of `index` (1..3); `kind` "
       "(horizontal, vertical) adds one or switches it; the others change that of `index`, default the last; "
       "nothing: all "
       "on or off",
       [](Session& session, const Command& command) {
         if (command.arguments.empty() || command.has("kind")) return session.switchPlanes(command);
         session.changePlane(command);
       }},
      {"compare",
       {{"on", kBoolean, false}},
       "Shows the difference to the scenario as it was opened (or to that of --compare), or the field again",
       [](Session& session, const Command& command) {
         session.changeComparison(command.boolean("on", !session.compares()));
       }},
      {"split",
       {{"position", kNumber, false, {0, 1}}, {"on", kBoolean, false}},
       "Shows the scenario as it was opened (or that of --compare) at the left of the field, up to a part of "
       "the "
       "width, 0..1; nothing: on or off",
       [](Session& session, const Command& command) {
         const bool turns_on = command.boolean("on", command.has("position") || !session.isSplit());
         session.changeSplit(turns_on ? command.number("position", session.last_split_) : 0);
       }},
  };
}

}  // namespace emscape::view
