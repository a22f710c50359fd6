/// Cameras: text form, fitting to a box, and the rays of pixels.
#pragma once

#include <optional>
#include <string>

#include "emscape/base/vec.h"
#include "emscape/render/picture/image.h"
#include "emscape/volume/grid.h"

namespace emscape::render {

/// The volume's box in frame metres and its vertical exaggeration: heights are stretched about the box's
/// bottom. *Drawn* positions are those after the stretch. Camera holds drawn positions; all interfaces take
/// frame metres.
struct SceneBox {
  Vec3d lower_m;
  Vec3d upper_m;
  double vertical_exaggeration = 1;

  Vec3d toDrawn(const Vec3d& frame_m) const {
    return {frame_m.x, frame_m.y, lower_m.z + (frame_m.z - lower_m.z) * vertical_exaggeration};
  }
  Vec3d toFrame(const Vec3d& drawn_m) const {
    return {drawn_m.x, drawn_m.y, lower_m.z + (drawn_m.z - lower_m.z) / vertical_exaggeration};
  }
  Vec3d drawnUpper_m() const { return toDrawn(upper_m); }
  Vec3d drawnCenter_m() const { return (lower_m + drawnUpper_m()) * 0.5; }
  double drawnDiagonal_m() const { return length(drawnUpper_m() - lower_m); }
};

/// @param vertical_exaggeration  > 0; 0: niceVerticalExaggeration()
/// @throws Error (bad_input) if it is negative or not finite
SceneBox sceneBoxOf(const volume::Grid& grid, double vertical_exaggeration);
/// 1 for volumes without a position on the earth; else the round number (1, 1.5, 2, 3, 4, 5, ...) that makes
/// the box at least about a third as high as it is wide, at most 20.
double niceVerticalExaggeration(const volume::Grid& grid);

enum class Projection { perspective, orthographic };

/// Description of a camera. Angles in degrees.
struct CameraSpec {
  enum class Kind { orbit, lookat };
  Kind kind = Kind::orbit;
  Projection projection = Projection::perspective;
  double fov_deg = 35;  ///< vertical field of view; orthographic: the same scale at the target

  double azimuth_deg = 155;        ///< orbit: bearing of the camera from the target, clockwise from north
  double elevation_deg = 28;       ///< orbit: of the camera above the target, as drawn
  std::optional<double> distance;  ///< orbit: distance of camera and target in diagonals of the drawn box;
                                   ///< none: fitted to the whole box
  std::optional<Vec3d> target_m;   ///< orbit: frame metres; none: the box's centre. lookat: required
  std::optional<Vec3d> eye_m;      ///< lookat: frame metres, required
};

/// Parses
/// `orbit:azimuth_deg=225,elevation_deg=30,distance=1.8,fov_deg=35,projection=perspective,target_x_m=..,target_y_m=..,
/// target_z_m=..` or
/// `lookat:eye_x_m=..,eye_y_m=..,eye_z_m=..,target_x_m=..,target_y_m=..,target_z_m=..,fov_deg=..`; every key
/// of an orbit may be left out, and "orbit" alone is the default view.
/// @throws Error (usage) that names the key, the value and what is allowed
CameraSpec parseCamera(const std::string& text);
/// The text of a camera; parseCamera() reads it back exactly.
std::string toString(const CameraSpec& spec);

/// Margins that stay free when a camera is fitted to a box: fractions 0..1 of the picture's width (left,
/// right) and height.
struct FrameMargins {
  double left = 0.04, right = 0.04, top = 0.04, bottom = 0.04;
};

/// A camera in drawn positions. The image plane is one unit in front of the eye; half_height is half its
/// visible height (orthographic: half the height of the picture in metres).
struct Camera {
  Vec3d eye_m;
  Vec3d forward, right, up;  ///< unit vectors
  Projection projection = Projection::perspective;
  double half_height = 0.3;
  double shift_x = 0, shift_y = 0;  ///< lens shift of the picture's centre, in half heights

  /// Position of the centre of pixel (x, y) on the image plane, in half heights from the principal point; x
  /// and y may be fractional.
  double planeX(double x, ImageSize size) const {
    return (2.0 * (x + 0.5) - size.width) / size.height + shift_x;
  }
  double planeY(double y, ImageSize size) const { return 1.0 - 2.0 * (y + 0.5) / size.height + shift_y; }
};

/// @throws Error (usage) if a lookat's eye and target coincide
Camera makeCamera(const CameraSpec& spec, const SceneBox& box, ImageSize size,
                  const FrameMargins& margins = {});

/// A projected point: pixel coordinates (fractional; (0, 0) is the centre of the first pixel) and depth along
/// the view direction (m); not visible if the point is behind the eye.
struct Projected {
  double x = 0, y = 0, depth_m = 0;
  bool in_front = false;
};
Projected project(const Camera& camera, ImageSize size, const Vec3d& drawn_m);

}  // namespace emscape::render
