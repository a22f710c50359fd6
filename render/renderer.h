/// Volume -> picture, kept between frames.
#pragma once

#include <memory>

#include "base/progress.h"
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
  bool skip_empty = true;  ///< skip bricks that cannot change the picture; the picture is the same either way
  double vertical_exaggeration = 0;  ///< 0: niceVerticalExaggeration()
};

/// What a cast took.
struct CastReport {
  long long rays = 0;
  double ms = 0;
  bool complete = true;  ///< false: it was stopped; the picture then holds nothing to be shown
};

/// One frame's times.
struct FrameReport {
  Pattern pattern = Pattern::full;
  CastReport cast;
  double interpolate_ms = 0;
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
  const Camera& camera() const;
  /// The box of the volume as it is drawn. A volume must be set.
  SceneBox sceneBox() const;
  /// Whether the ground hides a position (frame metres) from the camera.
  bool isHidden(const Vec3d& frame_m) const;

  /// Casts the source pixels of a pattern into an image (resized to `size`); the others are left unwritten.
  /// @param stop  set from elsewhere: returns soon, incomplete. May be null
  CastReport cast(Pattern pattern, ImageSize size, Image& image, const StopFlag* stop = nullptr);
  /// Casts exactly the pixels that the pattern left out: the image is then bit-identical to a full cast of
  /// the same scene.
  CastReport restore(Pattern pattern, Image& image, const StopFlag* stop = nullptr);
  /// cast() and interpolate().
  Image render(ImageSize size, Pattern pattern = Pattern::full,
               Interpolation interpolation = Interpolation::float32, FrameReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
