/// Volume -> picture, kept between frames.
#pragma once

#include <limits>
#include <memory>

#include "base/progress.h"
#include "render/adaptive.h"
#include "render/camera.h"
#include "render/compositing.h"
#include "render/height_field.h"
#include "render/image.h"
#include "render/reconstruction.h"
#include "render/transfer_function.h"
#include "volume/dense_volume.h"

namespace emscape::render {

struct RenderSettings {
  CompositingMode mode = CompositingMode::dvr;
  double step_voxels = 1;  ///< between samples, in voxels along the ray; 0.05..10
  double mida_gamma = 0;   ///< -1 (DVR) .. 0 (MIDA) .. 1 (MIP)
  bool exact = false;      ///< true: no early termination
  bool shading = false;    ///< light on the fog of DVR and MIDA; isosurfaces always have it
  /// Value of the isosurface; NaN: the middle of the transfer function's interval
  double iso_value = std::numeric_limits<double>::quiet_NaN();
  double iso_opacity = 1;  ///< 0..1
  bool skip_empty = true;  ///< skip bricks that cannot change the picture; the picture is the same either way
  bool plain = false;      ///< the reference form of the ray caster; slow, for comparison
  double vertical_exaggeration = 0;  ///< 0: niceVerticalExaggeration()
};

/// How the pixels of a frame are come by.
struct FramePlan {
  Pattern pattern = Pattern::full;
  Interpolation interpolation = Interpolation::float32;  ///< adaptive predicts in float always
  double tolerance_levels = kDefaultTolerance_levels;    ///< of adaptive, see AdaptiveFrame::draw()
  /// Of adaptive: part of the pixels whose ray meets the box that frames keep to, after the first few; > 0
  double ray_share = kDefaultRayShare;
};

/// What a frame, or the restoration of one, took.
struct FrameReport {
  Pattern pattern = Pattern::full;
  long long rays = 0;
  long long samples = 0;  ///< taken of the volume; 0 where they are not counted (the plain form)
  double cast_ms = 0;
  double interpolate_ms = 0;
  bool complete = true;  ///< false: it was stopped; the picture then holds nothing to be shown

  double total_ms() const { return cast_ms + interpolate_ms; }
};

/// Casts a scene: volume, ground, transfer function, camera. A scene's pixel depends on its coordinates and
/// the picture's size alone, never on the pattern that casts it. One thread calls it; it uses all that
/// base/parallel.h allows.
class Renderer {
 public:
  Renderer();
  ~Renderer();

  /// The volume is read where it lies, not copied; it must not change until the next call. Cheap where the
  /// grid stays the same.
  void setVolume(std::shared_ptr<const volume::DenseVolume> volume);
  /// Null: no ground is drawn. @throws Error (bad_input) for an impossible field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// @throws Error (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const RenderSettings& settings() const;
  const TransferFunction& transferFunction() const;
  /// The value of the isosurface that is drawn in that mode.
  double isoValue() const;
  const Camera& camera() const;
  /// The box of the volume as it is drawn. A volume must be set.
  SceneBox sceneBox() const;
  /// Whether the ground hides a position (frame metres) from the camera.
  bool isHidden(const Vec3d& frame_m) const;

  /// Draws a frame of the scene: casts the source pixels of the plan's pattern and interpolates the others.
  /// @param image  resized to `size`
  /// @param stop   set from elsewhere: returns soon, incomplete. May be null
  FrameReport draw(const FramePlan& plan, ImageSize size, Image& image, const StopFlag* stop = nullptr);
  /// Casts exactly the pixels that the last draw() left out, into the image that it drew: the image is then
  /// bit-identical to a full one of the same scene, which must not have changed in between. A stopped
  /// restoration begins anew.
  FrameReport restore(Image& image, const StopFlag* stop = nullptr);
  /// draw() into an image of its own.
  Image render(ImageSize size, const FramePlan& plan = {}, FrameReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
