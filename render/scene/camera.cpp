#include "emscape/render/scene/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "render/scene/spec_text.h"

namespace emscape::render {
namespace {

constexpr double kMinFov_deg = 1;
constexpr double kMaxFov_deg = 150;
constexpr double kMinDistance = 0.01;
constexpr double kMaxDistance = 1000;
constexpr double kMaxExaggeration = 20;
/// Target of the minimum height of the drawn box, relative to its longer side.
constexpr double kHeightWanted = 0.32;

// --- text form ---

/// One key of the text form: a number, its range, and its destination.
struct CameraKey {
  const char* name;
  double least, largest;
  void (*set)(CameraSpec&, double);
};

Vec3d& orNew(std::optional<Vec3d>& position) {
  return position ? *position : position.emplace();
}

constexpr double kFar_m = 1e9;
const std::vector<CameraKey>& commonKeys() {
  static const std::vector<CameraKey> keys{
      {"fov_deg", kMinFov_deg, kMaxFov_deg, [](CameraSpec& s, double v) { s.fov_deg = v; }},
      {"target_x_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.target_m).x = v; }},
      {"target_y_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.target_m).y = v; }},
      {"target_z_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.target_m).z = v; }}};
  return keys;
}
const std::vector<CameraKey>& ownKeys(CameraSpec::Kind kind) {
  static const std::vector<CameraKey> orbit{
      {"azimuth_deg", -360, 360, [](CameraSpec& s, double v) { s.azimuth_deg = v; }},
      {"elevation_deg", -90, 90, [](CameraSpec& s, double v) { s.elevation_deg = v; }},
      {"distance", kMinDistance, kMaxDistance, [](CameraSpec& s, double v) { s.distance = v; }}};
  static const std::vector<CameraKey> lookat{
      {"eye_x_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.eye_m).x = v; }},
      {"eye_y_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.eye_m).y = v; }},
      {"eye_z_m", -kFar_m, kFar_m, [](CameraSpec& s, double v) { orNew(s.eye_m).z = v; }}};
  return kind == CameraSpec::Kind::orbit ? orbit : lookat;
}

Projection parseProjection(const SpecText& text, const std::string& value) {
  if (value == "perspective") return Projection::perspective;
  if (value == "orthographic") return Projection::orthographic;
  text.refuse(fmt::format("projection '{}': expected perspective or orthographic", value));
}

void setKey(CameraSpec& spec, const SpecText& text, const std::string& key, const std::string& value) {
  if (key == "projection") {
    spec.projection = parseProjection(text, value);
    return;
  }
  std::string allowed = "projection";
  for (const std::vector<CameraKey>* keys : {&ownKeys(spec.kind), &commonKeys()}) {
    for (const CameraKey& known : *keys) {
      allowed += std::string(", ") + known.name;
      if (key != known.name) continue;
      known.set(spec, text.number(key, value, known.least, known.largest));
      return;
    }
  }
  text.refuseKey(key, allowed);
}

void requireWholePosition(const SpecText& text, const std::string& name, bool required) {
  int given = 0;
  for (const char* axis : {"_x_m", "_y_m", "_z_m"}) given += text.has(name + axis) ? 1 : 0;
  if (given != 3 && (required || given > 0)) {
    text.refuse(fmt::format("{0}_x_m, {0}_y_m and {0}_z_m are needed together", name));
  }
}

// --- axes and fitting ---

struct Axes {
  Vec3d forward, right, up;
};

Axes axesOf(const Vec3d& forward, const Vec3d& right) {
  return {forward, right, cross(right, forward)};
}

Axes orbitAxes(double azimuth_deg, double elevation_deg) {
  const double azimuth = degToRad(azimuth_deg);
  const double elevation = degToRad(elevation_deg);
  const Vec3d outward{std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                      std::sin(elevation)};
  return axesOf(-outward, {-std::cos(azimuth), std::sin(azimuth), 0});
}

Axes lookAxes(const Vec3d& forward) {
  const double horizontal = std::hypot(forward.x, forward.y);
  if (horizontal < 1e-9) return axesOf(forward, {1, 0, 0});  // straight up or down: north is up
  return axesOf(forward, {forward.y / horizontal, -forward.x / horizontal, 0});
}

std::array<Vec3d, 8> cornersOf(const SceneBox& box) {
  const Vec3d& low = box.lower_m;
  const Vec3d high = box.drawnUpper_m();
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                  (i & 4) != 0 ? high.z : low.z};
  }
  return corners;
}

/// Extent of the box in the plane one unit in front of the eye (perspective), or in the plane through the eye
/// (orthographic).
struct ViewExtent {
  double least_x = 1e300, largest_x = -1e300, least_y = 1e300, largest_y = -1e300;
  bool in_front = true;
};

ViewExtent extentOf(const SceneBox& box, const Axes& axes, const Vec3d& eye, Projection projection) {
  ViewExtent extent;
  for (const Vec3d& corner : cornersOf(box)) {
    const Vec3d offset = corner - eye;
    const double depth = dot(offset, axes.forward);
    if (depth <= 0) extent.in_front = false;
    const double scale = projection == Projection::perspective ? 1.0 / depth : 1.0;
    const double x = dot(offset, axes.right) * scale;
    const double y = dot(offset, axes.up) * scale;
    extent.least_x = std::min(extent.least_x, x);
    extent.largest_x = std::max(extent.largest_x, x);
    extent.least_y = std::min(extent.least_y, y);
    extent.largest_y = std::max(extent.largest_y, y);
  }
  return extent;
}

/// The part of a picture inside the margins, in half heights of the picture.
struct FreeArea {
  double width, height, center_x, center_y;
};

FreeArea freeArea(ImageSize size, const FrameMargins& margins) {
  const double aspect = static_cast<double>(size.width) / size.height;
  return {2 * aspect * std::max(0.05, 1 - margins.left - margins.right),
          2 * std::max(0.05, 1 - margins.top - margins.bottom), aspect * (margins.left - margins.right),
          margins.bottom - margins.top};
}

/// Ratio of the size of the box to the free area, with half_height as scale.
double overflowOf(const ViewExtent& extent, const FreeArea& area, double half_height) {
  return std::max((extent.largest_x - extent.least_x) / area.width,
                  (extent.largest_y - extent.least_y) / area.height) /
         half_height;
}

/// Minimum distance from which the whole box fits (perspective).
double fittingDistance_m(const SceneBox& box, const Axes& axes, const Vec3d& target, const FreeArea& area,
                         double half_height) {
  double too_near = 0;
  double far = box.drawnDiagonal_m();
  const auto fits = [&](double distance) {
    const ViewExtent extent = extentOf(box, axes, target - axes.forward * distance, Projection::perspective);
    return extent.in_front && overflowOf(extent, area, half_height) <= 1;
  };
  while (!fits(far)) far *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (too_near + far);
    (fits(middle) ? far : too_near) = middle;
  }
  return far;
}

void fitOrbit(Camera& camera, const SceneBox& box, const Axes& axes, const Vec3d& target,
              const FreeArea& area) {
  if (camera.projection == Projection::perspective) {
    camera.eye_m = target - axes.forward * fittingDistance_m(box, axes, target, area, camera.half_height);
  } else {
    camera.eye_m = target - axes.forward * (2 * box.drawnDiagonal_m());
    camera.half_height = overflowOf(extentOf(box, axes, camera.eye_m, camera.projection), area, 1.0);
  }
  const ViewExtent extent = extentOf(box, axes, camera.eye_m, camera.projection);
  camera.shift_x = 0.5 * (extent.least_x + extent.largest_x) / camera.half_height - area.center_x;
  camera.shift_y = 0.5 * (extent.least_y + extent.largest_y) / camera.half_height - area.center_y;
}

}  // namespace

double niceVerticalExaggeration(const volume::Grid& grid) {
  if (!grid.georeferenced) return 1;
  const Vec3d size = grid.upper_m() - grid.lower_m();
  const double wanted = kHeightWanted * std::max(size.x, size.y) / size.z;
  for (double nice : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0}) {
    if (nice >= wanted) return nice;
  }
  return kMaxExaggeration;
}

SceneBox sceneBoxOf(const volume::Grid& grid, double vertical_exaggeration) {
  if (!(vertical_exaggeration >= 0) || !std::isfinite(vertical_exaggeration)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("vertical exaggeration {}: expected a number above 0", vertical_exaggeration));
  }
  return {grid.lower_m(), grid.upper_m(),
          vertical_exaggeration > 0 ? vertical_exaggeration : niceVerticalExaggeration(grid)};
}

CameraSpec parseCamera(const std::string& text) {
  const SpecText parts("camera", text, {"orbit", "lookat"}, "orbit:KEY=VALUE,... or lookat:KEY=VALUE,...");
  CameraSpec spec;
  if (parts.kind() == "lookat") spec.kind = CameraSpec::Kind::lookat;
  for (const auto& [key, value] : parts.entries()) setKey(spec, parts, key, value);
  const bool lookat = spec.kind == CameraSpec::Kind::lookat;
  requireWholePosition(parts, "target", lookat);
  if (lookat) requireWholePosition(parts, "eye", true);
  return spec;
}

std::string toString(const CameraSpec& spec) {
  std::string text =
      spec.kind == CameraSpec::Kind::orbit
          ? fmt::format("orbit:azimuth_deg={},elevation_deg={}", spec.azimuth_deg, spec.elevation_deg)
          : fmt::format("lookat:eye_x_m={},eye_y_m={},eye_z_m={}", spec.eye_m->x, spec.eye_m->y,
                        spec.eye_m->z);
  if (spec.kind == CameraSpec::Kind::orbit && spec.distance)
    text += fmt::format(",distance={}", *spec.distance);
  if (spec.target_m) {
    text += fmt::format(",target_x_m={},target_y_m={},target_z_m={}", spec.target_m->x, spec.target_m->y,
                        spec.target_m->z);
  }
  text += fmt::format(",fov_deg={}", spec.fov_deg);
  if (spec.projection == Projection::orthographic) text += ",projection=orthographic";
  return text;
}

Camera makeCamera(const CameraSpec& spec, const SceneBox& box, ImageSize size, const FrameMargins& margins) {
  const FreeArea area = freeArea(size, margins);
  const double tangent = std::tan(degToRad(spec.fov_deg) / 2);
  const Vec3d target = spec.target_m ? box.toDrawn(*spec.target_m) : box.drawnCenter_m();
  Camera camera;
  camera.projection = spec.projection;
  camera.half_height = tangent;
  camera.shift_x = -area.center_x;
  camera.shift_y = -area.center_y;
  Axes axes;
  double distance_m = 0;
  if (spec.kind == CameraSpec::Kind::lookat) {
    camera.eye_m = box.toDrawn(spec.eye_m.value());
    distance_m = length(target - camera.eye_m);
    if (!(distance_m > 0)) throw Error(ErrorCode::usage, "camera: eye and target are the same point");
    axes = lookAxes((target - camera.eye_m) / distance_m);
  } else {
    axes = orbitAxes(spec.azimuth_deg, spec.elevation_deg);
    distance_m = spec.distance.value_or(0) * box.drawnDiagonal_m();
    camera.eye_m = target - axes.forward * distance_m;
  }
  if (spec.projection == Projection::orthographic) camera.half_height = tangent * distance_m;
  if (distance_m == 0) fitOrbit(camera, box, axes, target, area);
  camera.forward = axes.forward;
  camera.right = axes.right;
  camera.up = axes.up;
  return camera;
}

Projected project(const Camera& camera, ImageSize size, const Vec3d& drawn_m) {
  const Vec3d offset = drawn_m - camera.eye_m;
  Projected result;
  result.depth_m = dot(offset, camera.forward);
  result.in_front = camera.projection == Projection::orthographic || result.depth_m > 0;
  const double scale =
      camera.half_height * (camera.projection == Projection::orthographic ? 1.0 : result.depth_m);
  const double plane_x = dot(offset, camera.right) / scale - camera.shift_x;
  const double plane_y = dot(offset, camera.up) / scale - camera.shift_y;
  result.x = 0.5 * (plane_x * size.height + size.width) - 0.5;
  result.y = 0.5 * (1.0 - plane_y) * size.height - 0.5;
  return result;
}

}  // namespace emscape::render
