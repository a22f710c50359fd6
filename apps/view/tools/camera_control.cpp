#include "apps/view/tools/camera_control.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"

namespace emscape::view {
namespace {

constexpr double kMaxElevation_deg = 90;
constexpr double kMinDistance = 0.02;  // diagonals of the drawn box
constexpr double kMaxDistance = 50;

double wrapped_deg(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  return rest < 0 ? rest + 360 : rest;
}

/// Limits a target (frame metres) to kMaxDistance around the box along each axis: a camera can then be drawn
/// and saved.
Vec3d nearBox(const Vec3d& target_m, const render::SceneBox& box) {
  const double reach_m = kMaxDistance * box.drawnDiagonal_m();
  const Vec3d& low_m = box.lower_m;
  const Vec3d& high_m = box.upper_m;
  return {std::clamp(target_m.x, low_m.x - reach_m, high_m.x + reach_m),
          std::clamp(target_m.y, low_m.y - reach_m, high_m.y + reach_m),
          std::clamp(target_m.z, low_m.z - reach_m, high_m.z + reach_m)};
}

}  // namespace

double CameraControl::Pose::metresPerPixel(render::ImageSize size) const {
  const double half_height_m = camera.projection == render::Projection::perspective
                                   ? camera.half_height * distance_m
                                   : camera.half_height;
  return 2 * half_height_m / size.height;
}

CameraControl::Pose CameraControl::poseIn(const Viewport& viewport) const {
  Pose pose;
  pose.camera = render::makeCamera(spec_, viewport.box, viewport.size, viewport.margins);
  pose.target_m = spec_.target_m ? viewport.box.toDrawn(*spec_.target_m) : viewport.box.drawnCenter_m();
  pose.distance_m = dot(pose.target_m - pose.camera.eye_m, pose.camera.forward);
  return pose;
}

void CameraControl::settle(const Viewport& viewport) {
  const bool settled = spec_.kind == render::CameraSpec::Kind::orbit && spec_.distance && spec_.target_m;
  if (settled) return;
  Pose pose = poseIn(viewport);
  if (spec_.kind == render::CameraSpec::Kind::lookat) {
    pose.distance_m = length(pose.target_m - pose.camera.eye_m);
  } else if (spec_.projection == render::Projection::orthographic && !spec_.distance) {
    pose.distance_m = pose.camera.half_height / std::tan(degToRad(spec_.fov_deg) / 2);
  }
  const double diagonal_m = viewport.box.drawnDiagonal_m();
  render::CameraSpec orbit = spec_;
  orbit.kind = render::CameraSpec::Kind::orbit;
  orbit.eye_m.reset();
  orbit.distance = std::clamp(pose.distance_m / diagonal_m, kMinDistance, kMaxDistance);
  if (spec_.kind == render::CameraSpec::Kind::lookat) {
    // The azimuth from the axis to the right, which is also defined straight above the target.
    orbit.elevation_deg = radToDeg(std::asin(std::clamp(-pose.camera.forward.z, -1.0, 1.0)));
    orbit.azimuth_deg = wrapped_deg(radToDeg(std::atan2(pose.camera.right.y, -pose.camera.right.x)));
  }
  orbit.target_m = viewport.box.toFrame(pose.target_m);
  // A fitted camera shifts its lens; from here on the target is moved instead.
  const render::Camera unshifted = render::makeCamera(orbit, viewport.box, viewport.size, viewport.margins);
  const double per_half_height_m = pose.metresPerPixel(viewport.size) * viewport.size.height / 2;
  const double right = (pose.camera.shift_x - unshifted.shift_x) * per_half_height_m;
  const double up = (pose.camera.shift_y - unshifted.shift_y) * per_half_height_m;
  orbit.target_m = viewport.box.toFrame(pose.target_m + pose.camera.right * right + pose.camera.up * up);
  spec_ = orbit;
}

void CameraControl::moveTarget(const Vec3d& drawn_m, const Viewport& viewport) {
  spec_.target_m =
      nearBox(viewport.box.toFrame(viewport.box.toDrawn(*spec_.target_m) + drawn_m), viewport.box);
}

void CameraControl::orbit(double azimuth_deg, double elevation_deg, const Viewport& viewport) {
  settle(viewport);
  spec_.azimuth_deg = wrapped_deg(spec_.azimuth_deg + azimuth_deg);
  spec_.elevation_deg =
      std::clamp(spec_.elevation_deg + elevation_deg, -kMaxElevation_deg, kMaxElevation_deg);
}

void CameraControl::pan(double right_px, double down_px, const Viewport& viewport) {
  settle(viewport);
  const Pose pose = poseIn(viewport);
  const double scale_m = pose.metresPerPixel(viewport.size);
  moveTarget(pose.camera.up * (down_px * scale_m) - pose.camera.right * (right_px * scale_m), viewport);
}

void CameraControl::dolly(double factor, double x, double y, const Viewport& viewport) {
  settle(viewport);
  const Pose pose = poseIn(viewport);
  const double distance = std::clamp(*spec_.distance * factor, kMinDistance, kMaxDistance);
  const double kept = 1 - distance / *spec_.distance;
  const double half_height_m = pose.metresPerPixel(viewport.size) * viewport.size.height / 2;
  const double right_m = pose.camera.planeX(x, viewport.size) * half_height_m;
  const double up_m = pose.camera.planeY(y, viewport.size) * half_height_m;
  moveTarget(pose.camera.right * (right_m * kept) + pose.camera.up * (up_m * kept), viewport);
  spec_.distance = distance;
}

void CameraControl::look(double azimuth_deg, double elevation_deg, const Viewport& viewport) {
  settle(viewport);
  const Vec3d eye_m = poseIn(viewport).camera.eye_m;
  orbit(azimuth_deg, elevation_deg, viewport);
  moveTarget(eye_m - poseIn(viewport).camera.eye_m, viewport);
}

void CameraControl::fly(double forward, double right, double up, const Viewport& viewport) {
  settle(viewport);
  const render::Camera camera = poseIn(viewport).camera;
  const double diagonal_m = viewport.box.drawnDiagonal_m();
  moveTarget((camera.forward * forward + camera.right * right + camera.up * up) * diagonal_m, viewport);
}

void CameraControl::setProjection(render::Projection projection, const Viewport& viewport) {
  settle(viewport);
  spec_.projection = projection;
}

void CameraControl::focus(const Vec3d& target_m, double distance, const Viewport& viewport) {
  settle(viewport);
  spec_.target_m = nearBox(target_m, viewport.box);
  spec_.distance = std::clamp(distance, kMinDistance, kMaxDistance);
}

}  // namespace emscape::view
