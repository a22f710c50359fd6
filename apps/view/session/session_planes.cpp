/// Verbs of comparison and cutting planes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/session/session.h"
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
  if (picture_) plane.altitude_m = std::round(0.5 * (picture_->box.lower_m.z + picture_->box.upper_m.z));
  return plane;
}

void Session::setPlanes(const std::vector<CutPlane>& planes) {
  render::checkCutPlanes(planes);
  change([&](playback::ViewState& view) { view.settings.planes = planes; });
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

std::vector<Verb> Session::planeVerbs() {
  return {
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
         const bool compares = command.boolean("on", !session.compares());
         if (compares == session.compares()) return;
         session.takes_colors_ = true;
         const std::string& first = session.options_.view.compare;
         const std::string reference = first.empty() ? playback::kOriginal : first;
         session.change([&](playback::ViewState& view) {
           playback::changeComparison(view, compares ? reference : std::string());
         });
         const bool is_of_itself = reference == playback::kOriginal && session.viewState().edits.empty();
         if (compares && is_of_itself) session.tell("nothing is changed: no difference");
       }},
  };
}

}  // namespace emscape::view
