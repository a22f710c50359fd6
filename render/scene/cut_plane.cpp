#include "emscape/render/scene/cut_plane.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "render/scene/spec_text.h"

namespace emscape::render {
namespace {

constexpr double kMaxAltitude_m = 1e6;
constexpr double kMaxBearing_deg = 360;
constexpr double kFarthest_m = 1e9;
constexpr std::array<const char*, 4> kSides{"below", "above", "left", "right"};

const char* nameOf(CutPlane::Side side) {
  return kSides[static_cast<std::size_t>(side)];
}

bool fits(CutPlane::Kind kind, CutPlane::Side side) {
  const bool of_horizontal = side == CutPlane::Side::below || side == CutPlane::Side::above;
  return of_horizontal == (kind == CutPlane::Kind::horizontal);
}

CutPlane::Side parseSide(const SpecText& text, CutPlane::Kind kind, const std::string& value) {
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    const auto side = static_cast<CutPlane::Side>(i);
    if (value == kSides[i] && fits(kind, side)) return side;
  }
  text.refuse(fmt::format("keep '{}': expected {}", value,
                          kind == CutPlane::Kind::horizontal ? "below or above" : "left or right"));
}

bool parseSwitch(const SpecText& text, const std::string& value) {
  if (value == "true") return true;
  if (value == "false") return false;
  text.refuse(fmt::format("on '{}': expected true or false", value));
}

bool parseGround(const SpecText& text, const CutPlane& plane, const std::string& value) {
  if (plane.kind == CutPlane::Kind::horizontal) text.refuse("ground: a horizontal plane leaves it whole");
  if (value == "cut") return true;
  if (value == "keep") return false;
  text.refuse(fmt::format("ground '{}': expected cut or keep", value));
}

/// The two points of a line.
struct LinePoints {
  double x1_m = 0, y1_m = 0, x2_m = 0, y2_m = 0;
};

/// A number of a text form and its destination.
struct PlaneKey {
  const char* name;
  double largest;  ///< its negative is the minimum
  void (*set)(CutPlane&, LinePoints&, double);
};

const std::vector<PlaneKey>& keysOf(CutPlane::Kind kind) {
  static const std::vector<PlaneKey> horizontal{
      {"altitude_m", kMaxAltitude_m, [](CutPlane& p, LinePoints&, double v) { p.altitude_m = v; }}};
  static const std::vector<PlaneKey> vertical{
      {"bearing_deg", kMaxBearing_deg, [](CutPlane& p, LinePoints&, double v) { p.bearing_deg = v; }},
      {"x_m", kFarthest_m, [](CutPlane& p, LinePoints&, double v) { p.x_m = v; }},
      {"y_m", kFarthest_m, [](CutPlane& p, LinePoints&, double v) { p.y_m = v; }},
      {"offset_m", kFarthest_m, [](CutPlane& p, LinePoints&, double v) { p.offset_m = v; }},
      {"x1_m", kFarthest_m, [](CutPlane&, LinePoints& line, double v) { line.x1_m = v; }},
      {"y1_m", kFarthest_m, [](CutPlane&, LinePoints& line, double v) { line.y1_m = v; }},
      {"x2_m", kFarthest_m, [](CutPlane&, LinePoints& line, double v) { line.x2_m = v; }},
      {"y2_m", kFarthest_m, [](CutPlane&, LinePoints& line, double v) { line.y2_m = v; }}};
  return kind == CutPlane::Kind::horizontal ? horizontal : vertical;
}

/// The line through the two points, if they are given.
void setLine(CutPlane& plane, const SpecText& text, const LinePoints& line) {
  int given = 0;
  for (const char* key : {"x1_m", "y1_m", "x2_m", "y2_m"}) given += text.has(key) ? 1 : 0;
  if (given == 0) return;
  if (given != 4) text.refuse("x1_m, y1_m, x2_m and y2_m are needed together");
  for (const char* key : {"x_m", "y_m", "bearing_deg"}) {
    if (text.has(key)) text.refuse(fmt::format("{} does not go with two points, x1_m..y2_m", key));
  }
  const double east_m = line.x2_m - line.x1_m;
  const double north_m = line.y2_m - line.y1_m;
  if (east_m == 0 && north_m == 0) text.refuse("the two points are the same");
  plane.x_m = line.x1_m;
  plane.y_m = line.y1_m;
  plane.bearing_deg = radToDeg(std::atan2(east_m, north_m));
}

void requireWithin(const char* name, double value, double largest) {
  if (!(std::abs(value) <= largest)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("plane: {} {}: expected {}..{}", name, value, -largest, largest));
  }
}

}  // namespace

bool CutPlane::operator==(const CutPlane& other) const {
  return kind == other.kind && keep == other.keep && on == other.on && altitude_m == other.altitude_m &&
         bearing_deg == other.bearing_deg && x_m == other.x_m && y_m == other.y_m &&
         offset_m == other.offset_m && cuts_ground == other.cuts_ground;
}

CutPlane parseCutPlane(const std::string& text) {
  const SpecText parts("plane", text, {"horizontal", "vertical"},
                       "horizontal:altitude_m=.. or vertical:KEY=VALUE,...");
  CutPlane plane;
  if (parts.kind() == "vertical") {
    plane.kind = CutPlane::Kind::vertical;
    plane.keep = CutPlane::Side::left;
  }
  const std::vector<PlaneKey>& keys = keysOf(plane.kind);
  LinePoints line;
  for (const auto& [key, value] : parts.entries()) {
    if (key == "keep") {
      plane.keep = parseSide(parts, plane.kind, value);
      continue;
    }
    if (key == "on") {
      plane.on = parseSwitch(parts, value);
      continue;
    }
    if (key == "ground") {
      plane.cuts_ground = parseGround(parts, plane, value);
      continue;
    }
    std::string allowed = plane.kind == CutPlane::Kind::vertical ? "keep, on, ground" : "keep, on";
    const PlaneKey* found = nullptr;
    for (const PlaneKey& known : keys) {
      allowed += std::string(", ") + known.name;
      if (key == known.name) found = &known;
    }
    if (found == nullptr) parts.refuseKey(key, allowed);
    found->set(plane, line, parts.number(key, value, -found->largest, found->largest));
  }
  if (plane.kind == CutPlane::Kind::horizontal) {
    if (!parts.has("altitude_m")) parts.refuse("altitude_m is needed");
    return plane;
  }
  setLine(plane, parts, line);
  if (plane.x_m.has_value() != plane.y_m.has_value()) parts.refuse("x_m and y_m are needed together");
  return plane;
}

std::string toString(const CutPlane& plane) {
  std::string text;
  if (plane.kind == CutPlane::Kind::horizontal) {
    text = fmt::format("horizontal:altitude_m={}", plane.altitude_m);
  } else {
    text = fmt::format("vertical:bearing_deg={}", plane.bearing_deg);
    if (plane.x_m && plane.y_m) text += fmt::format(",x_m={},y_m={}", *plane.x_m, *plane.y_m);
    if (plane.offset_m != 0) text += fmt::format(",offset_m={}", plane.offset_m);
  }
  text += fmt::format(",keep={}", nameOf(plane.keep));
  if (plane.kind == CutPlane::Kind::vertical && !plane.cuts_ground) text += ",ground=keep";
  if (!plane.on) text += ",on=false";
  return text;
}

CutPlane flipped(CutPlane plane) {
  using Side = CutPlane::Side;
  switch (plane.keep) {
    case Side::below:
      plane.keep = Side::above;
      break;
    case Side::above:
      plane.keep = Side::below;
      break;
    case Side::left:
      plane.keep = Side::right;
      break;
    case Side::right:
      plane.keep = Side::left;
      break;
  }
  return plane;
}

void checkCutPlanes(const std::vector<CutPlane>& planes) {
  if (planes.size() > static_cast<std::size_t>(kMaxCutPlanes)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} cutting planes: expected at most {}", planes.size(), kMaxCutPlanes));
  }
  for (const CutPlane& plane : planes) {
    if (!fits(plane.kind, plane.keep)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("plane: keep {}: a {} plane has no such side", nameOf(plane.keep),
                              plane.kind == CutPlane::Kind::horizontal ? "horizontal" : "vertical"));
    }
    requireWithin("altitude_m", plane.altitude_m, kMaxAltitude_m);
    requireWithin("bearing_deg", plane.bearing_deg, kMaxBearing_deg);
    requireWithin("x_m", plane.x_m.value_or(0), kFarthest_m);
    requireWithin("y_m", plane.y_m.value_or(0), kFarthest_m);
    requireWithin("offset_m", plane.offset_m, kFarthest_m);
  }
}

}  // namespace emscape::render
