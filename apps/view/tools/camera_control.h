/// Interactive camera: orbit, pan, dolly, look around, fly. No window, no OpenGL.
#pragma once

#include "emscape/render/scene/camera.h"

namespace emscape::view {

/// Geometry of a picture, needed to convert movements from pixels.
struct Viewport {
  render::SceneBox box;
  render::ImageSize size;
  render::FrameMargins margins;  ///< kept free of the box
};

/// Holds a camera and moves it. After the first movement the camera is an orbit with a distance and a target:
/// a fitted camera does not jump when it is first moved, and a lookat camera becomes the orbit with the same
/// eye. A moved target stays within 50 diagonals of the drawn box. For use by one thread.
class CameraControl {
 public:
  explicit CameraControl(const render::CameraSpec& spec = {}) : spec_(spec) {}

  const render::CameraSpec& spec() const { return spec_; }
  void set(const render::CameraSpec& spec) { spec_ = spec; }
  /// The same view as an orbit with a distance and a target: films can fly between such cameras.
  render::CameraSpec settledSpec(const Viewport& viewport) const {
    CameraControl copy = *this;
    copy.settle(viewport);
    return copy.spec_;
  }

  /// Turns the camera about its target. Elevation is clamped to -90..90.
  /// @param azimuth_deg  clockwise as seen from above
  void orbit(double azimuth_deg, double elevation_deg, const Viewport& viewport);
  /// Moves the scene with the cursor, parallel to the picture.
  /// @param right_px, down_px  movement of the cursor
  void pan(double right_px, double down_px, const Viewport& viewport);
  /// Moves towards the target, which itself moves such that the point under the cursor in the target's plane
  /// stays fixed.
  /// @param factor  factor of the distance, > 0; 0.5 halves it
  /// @param x, y    cursor in pixels of the picture
  void dolly(double factor, double x, double y, const Viewport& viewport);
  /// Turns the camera about its eye. Angles as for orbit().
  void look(double azimuth_deg, double elevation_deg, const Viewport& viewport);
  /// Moves eye and target. @param forward, right, up  in diagonals of the drawn box, along the camera's axes
  void fly(double forward, double right, double up, const Viewport& viewport);
  /// Changes the projection; the scale at the target stays.
  void setProjection(render::Projection projection, const Viewport& viewport);
  /// Looks at a position from the present direction. @param target_m  frame metres
  void focus(const Vec3d& target_m, double distance, const Viewport& viewport);

 private:
  struct Pose {
    render::Camera camera;
    Vec3d target_m;  // drawn
    double distance_m = 0;
    double metresPerPixel(render::ImageSize size) const;
  };
  Pose poseIn(const Viewport& viewport) const;
  void settle(const Viewport& viewport);
  void moveTarget(const Vec3d& drawn_m, const Viewport& viewport);

  render::CameraSpec spec_;
};

}  // namespace emscape::view
