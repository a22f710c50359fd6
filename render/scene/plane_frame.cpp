#include "render/scene/plane_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/display_units.h"
#include "emscape/base/units.h"

namespace emscape::render {

std::optional<PlaneFrame> frameOf(const CutPlane& plane, const SceneBox& box) {
  const Vec3d& low = box.lower_m;
  const Vec3d& high = box.upper_m;
  if (plane.kind == CutPlane::Kind::horizontal) {
    const double z = plane.altitude_m;
    if (z < low.z || z > high.z) return std::nullopt;
    return PlaneFrame{{{{low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z}}},
                      {0, 0, 1}};
  }
  const double bearing_rad = degToRad(plane.bearing_deg);
  const Vec3d along{std::sin(bearing_rad), std::cos(bearing_rad), 0};
  const Vec3d right{along.y, -along.x, 0};
  const Vec3d point =
      Vec3d{plane.x_m.value_or((low.x + high.x) / 2), plane.y_m.value_or((low.y + high.y) / 2), 0} +
      right * plane.offset_m;
  double begin = -std::numeric_limits<double>::infinity(), end = -begin;
  const auto clip = [&](double from, double rate, double lower, double upper) {
    if (std::abs(rate) < 1e-12) {
      if (from < lower || from > upper) end = begin;
      return;
    }
    const double a = (lower - from) / rate, b = (upper - from) / rate;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  };
  clip(point.x, along.x, low.x, high.x);
  clip(point.y, along.y, low.y, high.y);
  if (!(begin < end)) return std::nullopt;
  const auto at = [&](double distance, double z) {
    const Vec3d on_line = point + along * distance;
    return Vec3d{on_line.x, on_line.y, z};
  };
  return PlaneFrame{{{at(begin, low.z), at(end, low.z), at(end, high.z), at(begin, high.z)}}, right};
}

std::string captionOf(const CutPlane& plane, Units units, bool is_on_earth) {
  const auto lengthOf = [&](double length_m) {
    return is_on_earth ? heightText(length_m, units) : fmt::format("{:.4g}", length_m);
  };
  if (plane.kind == CutPlane::Kind::horizontal)
    return (is_on_earth ? "altitude " : "z = ") + lengthOf(plane.altitude_m);
  std::string text = fmt::format("bearing {:.0f}°", plane.bearing_deg);
  if (plane.offset_m != 0) text += ", offset " + lengthOf(plane.offset_m);
  return text;
}

}  // namespace emscape::render
