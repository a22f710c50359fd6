#include "playback/editing/pick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "emscape/base/units.h"
#include "playback/editing/probe.h"

namespace emscape::playback {
namespace {

using volume::DenseVolume;

/// A ray in frame metres, origin + t * direction, with its interval inside the box.
struct Ray {
  Vec3d origin_m, direction;
  double begin = 0, end = 0;

  Vec3d at(double t) const { return origin_m + direction * t; }
};

/// The whole ray in front of the camera.
Ray rayOf(const render::Camera& camera, const render::SceneBox& box, render::ImageSize size, double x,
          double y) {
  const Vec3d on_plane = camera.right * (camera.planeX(x, size) * camera.half_height) +
                         camera.up * (camera.planeY(y, size) * camera.half_height);
  const bool is_perspective = camera.projection == render::Projection::perspective;
  const Vec3d eye = is_perspective ? camera.eye_m : camera.eye_m + on_plane;
  const Vec3d drawn = is_perspective ? camera.forward + on_plane : camera.forward;
  // toFrame() is affine: a line stays a line.
  const Vec3d origin = box.toFrame(eye);
  return {origin, box.toFrame(eye + drawn) - origin, 0, std::numeric_limits<double>::infinity()};
}

/// @return none if the ray misses the box, or the box is behind the eye
std::optional<Ray> rayThrough(const render::Camera& camera, const render::SceneBox& box,
                              render::ImageSize size, double x, double y) {
  Ray ray = rayOf(camera, box, size, x, y);
  const std::array<std::array<double, 4>, 3> axes{
      {{ray.origin_m.x, ray.direction.x, box.lower_m.x, box.upper_m.x},
       {ray.origin_m.y, ray.direction.y, box.lower_m.y, box.upper_m.y},
       {ray.origin_m.z, ray.direction.z, box.lower_m.z, box.upper_m.z}}};
  for (const auto& [from, along, lower, upper] : axes) {
    if (along == 0) {
      if (from < lower || from > upper) return std::nullopt;
      continue;
    }
    const double a = (lower - from) / along, b = (upper - from) / along;
    ray.begin = std::max(ray.begin, std::min(a, b));
    ray.end = std::min(ray.end, std::max(a, b));
  }
  if (!(ray.begin < ray.end)) return std::nullopt;
  return ray;
}

/// The half space that a plane keeps: dot(outward, position) <= offset, in frame metres.
struct HalfSpace {
  Vec3d outward;
  double offset_m = 0;
};

HalfSpace halfSpaceOf(const render::CutPlane& plane, const render::SceneBox& box) {
  using Side = render::CutPlane::Side;
  HalfSpace kept{{0, 0, 1}, plane.altitude_m};
  if (plane.kind == render::CutPlane::Kind::vertical) {
    const double bearing_rad = degToRad(plane.bearing_deg);
    kept.outward = {std::cos(bearing_rad), -std::sin(bearing_rad), 0};  // to the right of the line
    const Vec3d point{plane.x_m.value_or((box.lower_m.x + box.upper_m.x) / 2),
                      plane.y_m.value_or((box.lower_m.y + box.upper_m.y) / 2), 0};
    kept.offset_m = dot(kept.outward, point) + plane.offset_m;
  }
  if (plane.keep == Side::above || plane.keep == Side::right) {
    kept = {kept.outward * -1.0, -kept.offset_m};
  }
  return kept;
}

/// A ray clipped by planes.
struct ClippedRay {
  Ray ray;
  bool begins_at_plane = false, ends_at_plane = false;

  bool isEmpty() const { return !(ray.begin < ray.end); }
};

/// @param of_ground  by the planes that cut the ground
ClippedRay clipped(const Ray& ray, const std::vector<render::CutPlane>& planes, const render::SceneBox& box,
                   bool of_ground) {
  ClippedRay result{ray};
  for (const render::CutPlane& plane : planes) {
    if (!plane.on || (of_ground && !plane.cutsGround())) continue;
    const HalfSpace kept = halfSpaceOf(plane, box);
    const double rate = dot(kept.outward, ray.direction);
    const double inside = kept.offset_m - dot(kept.outward, ray.origin_m);
    if (rate == 0) {
      if (inside < 0) result.ray.end = result.ray.begin;
    } else if (rate < 0 && inside / rate > result.ray.begin) {
      result.ray.begin = inside / rate;
      result.begins_at_plane = true;
    } else if (rate > 0 && inside / rate < result.ray.end) {
      result.ray.end = inside / rate;
      result.ends_at_plane = true;
    }
  }
  return result;
}

/// Intersection of the ray with the ground: searched every half post, then bisected to a thousandth of that.
std::optional<double> meetGround(const Ray& ray, const render::HeightField& ground) {
  const auto clearance_m = [&](double t) {
    const Vec3d at = ray.at(t);
    return at.z - heightAt_m(ground, at.x, at.y);
  };
  const double posts =
      std::hypot(ray.direction.x / ground.spacing_x_m, ray.direction.y / ground.spacing_y_m) *
      (ray.end - ray.begin);
  const int steps = static_cast<int>(std::ceil(2 * posts)) + 1;
  double above = ray.begin;
  if (clearance_m(above) <= 0) return above;  // the side of the box, where the ground is cut
  for (int step = 1; step <= steps; ++step) {
    double below = ray.begin + (ray.end - ray.begin) * step / steps;
    if (!(clearance_m(below) <= 0)) {
      above = below;
      continue;
    }
    for (int half = 0; half < 30; ++half) {
      const double middle = 0.5 * (above + below);
      (clearance_m(middle) <= 0 ? below : above) = middle;
    }
    return below;
  }
  return std::nullopt;
}

/// Steps of half a voxel along a ray.
int halfVoxels(const Ray& ray, const DenseVolume& volume) {
  const Vec3d spacing_m = volume.grid.spacing_m;
  const double voxels = length(Vec3d{ray.direction.x / spacing_m.x, ray.direction.y / spacing_m.y,
                                     ray.direction.z / spacing_m.z}) *
                        (ray.end - ray.begin);
  return static_cast<int>(std::ceil(2 * voxels)) + 1;
}

/// The first point of the ray with at least a value.
std::optional<double> meetSurface(const Ray& ray, const DenseVolume& volume, double iso_value) {
  const auto isInside = [&](double t) {
    const VolumeSample sample = sampleVolume(volume, ray.at(t));
    return sample.kind == VolumeSample::Kind::value && double{sample.value} >= iso_value;
  };
  const int steps = halfVoxels(ray, volume);
  double outside = ray.begin;
  for (int step = 0; step <= steps; ++step) {
    double inside = ray.begin + (ray.end - ray.begin) * step / steps;
    if (!isInside(inside)) {
      outside = inside;
      continue;
    }
    for (int half = 0; half < 20; ++half) {
      const double middle = 0.5 * (outside + inside);
      (isInside(middle) ? inside : outside) = middle;
    }
    return inside;
  }
  return std::nullopt;
}

/// Position of the ray's largest value; none if it meets no field.
std::optional<double> strongestOn(const Ray& ray, const DenseVolume& volume) {
  const int steps = halfVoxels(ray, volume);
  std::optional<double> strongest;
  float largest = -std::numeric_limits<float>::infinity();
  for (int step = 0; step < steps; ++step) {
    const double t = ray.begin + (ray.end - ray.begin) * (step + 0.5) / steps;
    const VolumeSample sample = sampleVolume(volume, ray.at(t));
    if (sample.kind != VolumeSample::Kind::value || !(sample.value > largest)) continue;
    largest = sample.value;
    strongest = t;
  }
  return strongest;
}

}  // namespace

std::optional<PickedPoint> pick(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const DenseVolume& volume,
                                const render::HeightField* ground,
                                const std::vector<render::CutPlane>& planes,
                                std::optional<double> iso_value) {
  const std::optional<Ray> ray = rayThrough(camera, box, size, x, y);
  if (!ray) return std::nullopt;
  using On = PickedPoint::On;
  const ClippedRay kept = clipped(*ray, planes, box, /*of_ground=*/false);
  std::optional<double> ground_t;
  if (ground != nullptr) {
    const ClippedRay over_ground = clipped(*ray, planes, box, /*of_ground=*/true);
    if (!over_ground.isEmpty()) ground_t = meetGround(over_ground.ray, *ground);
  }
  const auto shows = [&](bool is_section, double t) {
    return is_section && !kept.isEmpty() && !(ground_t && *ground_t <= t) &&
           sampleVolume(volume, ray->at(t)).kind == VolumeSample::Kind::value;
  };
  if (shows(kept.begins_at_plane, kept.ray.begin)) return PickedPoint{ray->at(kept.ray.begin), On::section};
  if (iso_value && !volume.info.categorical && !kept.isEmpty()) {
    Ray before_ground = kept.ray;
    if (ground_t) before_ground.end = std::min(before_ground.end, *ground_t);
    if (before_ground.begin < before_ground.end) {
      if (const auto t = meetSurface(before_ground, volume, *iso_value))
        return PickedPoint{ray->at(*t), On::surface};
    }
  }
  if (shows(kept.ends_at_plane, kept.ray.end)) return PickedPoint{ray->at(kept.ray.end), On::section};
  if (ground_t) return PickedPoint{ray->at(*ground_t), On::ground};
  if (!volume.info.categorical && !kept.isEmpty()) {
    if (const auto t = strongestOn(kept.ray, volume)) return PickedPoint{ray->at(*t), On::strongest};
  }
  return PickedPoint{ray->at(ray->begin), On::box};
}

Vec3d aboveGround(const Vec3d& ground_m, double height_agl_m, const DenseVolume& volume,
                  const scenario::Terrain* terrain) {
  if (!volume.grid.georeferenced) return ground_m;
  const GeoFrame frame(volume.grid.frame);
  const GeodeticPosition below = frame.toGeodetic(ground_m);
  // Without terrain the smooth earth is drawn.
  const double ground_msl_m =
      terrain != nullptr ? terrain->heightMsl_m(below.latitude_deg, below.longitude_deg) : 0;
  if (std::isnan(ground_msl_m)) return ground_m;
  Vec3d position_m = ground_m;
  position_m.z += ground_msl_m + height_agl_m - frame.heightMsl_m(ground_m);
  // Moves to the lowest voxel above the ground, because the centre of the voxel at this height may be below
  // it.
  const VolumeSample sample = sampleVolume(volume, position_m);
  if (sample.kind != VolumeSample::Kind::masked || volume.first_valid_k.empty()) return position_m;
  const int first =
      volume.first_valid_k[static_cast<std::size_t>(sample.voxel.y) * volume.grid.dims.x + sample.voxel.x];
  if (first >= volume.grid.dims.z) return position_m;
  position_m.z =
      std::max(position_m.z, volume.grid.first_center_m.z + (first - 0.49) * volume.grid.spacing_m.z);
  return position_m;
}

std::optional<Vec3d> pickGround(const render::Camera& camera, const render::SceneBox& box,
                                render::ImageSize size, double x, double y, const render::HeightField& ground,
                                const std::vector<render::CutPlane>& planes) {
  const std::optional<Ray> ray = rayThrough(camera, box, size, x, y);
  if (!ray) return std::nullopt;
  const ClippedRay over_ground = clipped(*ray, planes, box, /*of_ground=*/true);
  if (over_ground.isEmpty()) return std::nullopt;
  const std::optional<double> t = meetGround(over_ground.ray, ground);
  return t ? std::optional(ray->at(*t)) : std::nullopt;
}

std::optional<Vec3d> pickLevel(const render::Camera& camera, const render::SceneBox& box,
                               render::ImageSize size, double x, double y, double z_m) {
  const Ray ray = rayOf(camera, box, size, x, y);
  const double t = (z_m - ray.origin_m.z) / ray.direction.z;
  if (!(t > 0) || !std::isfinite(t)) return std::nullopt;
  const Vec3d at = ray.at(t);
  const bool is_inside =
      at.x >= box.lower_m.x && at.x <= box.upper_m.x && at.y >= box.lower_m.y && at.y <= box.upper_m.y;
  return is_inside ? std::optional(at) : std::nullopt;
}

}  // namespace emscape::playback
