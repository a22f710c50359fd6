/// Volume -> picture, kept between frames.
#pragma once

#include <memory>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/render/camera.h"
#include "emscape/render/device_picture.h"
#include "emscape/render/frame.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/render/render_settings.h"
#include "emscape/render/transfer_function.h"
#include "emscape/volume/volume.h"

namespace emscape::render {

/// Where pictures are cast.
struct RendererOptions {
  Backend backend = Backend::cpu;  ///< automatic: the GPU if there is one that can, else the CPU
  /// How a GPU keeps volumes that come from the host's memory; sparse32: all volumes
  volume::VoxelPrecision precision = volume::VoxelPrecision::float32;
};

/// Casts a scene: volume, ground, transfer function, camera. A scene's pixel depends on its coordinates and
/// the picture's size alone, never on the pattern that casts it.
///
/// One thread calls it, but for setVolume(), which may be called by another one at any time: it waits for the
/// frame that is being drawn. On the CPU a frame uses all threads that base/parallel.h allows; on a GPU it is
/// cast on a stream of its own, while the next volume may be written on another.
class Renderer {
 public:
  /// With Backend::automatic one line of the log says what was taken and why.
  /// @throws Error (device) if cuda is requested and there is none
  explicit Renderer(const RendererOptions& options = {});
  ~Renderer();

  /// cpu or cuda.
  Backend backend() const;

  /// Values on the renderer's side (host memory for the CPU, GPU memory for the GPU) are read in place, not
  /// copied; reads and writes of a GPU wait for each other. Values on the other side are copied. Cheap
  /// where the grid stays the same.
  /// @throws Error (other) for an empty handle, (device) if a copy does not fit
  void setVolume(const volume::Volume& volume);
  /// Memory of the GPU that the volume takes; 0 with the CPU.
  std::size_t volumeBytes() const;
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
  /// Whether a position (frame metres) is on the removed side of a plane, or the ground hides it from the
  /// camera. A volume must be set.
  bool isHidden(const Vec3d& frame_m) const;

  /// Draws a frame of the scene: casts the source pixels of the plan's pattern and interpolates the others.
  /// The picture stays where it was cast.
  /// @param stop  set from elsewhere: returns soon, incomplete. May be null
  /// @throws Error (device)
  FrameReport draw(const FramePlan& plan, ImageSize size, const StopFlag* stop = nullptr);
  /// Casts exactly the pixels that the last draw() left out: the picture is then bit-identical to a full one
  /// of the same scene, which must not have changed in between. A stopped restoration starts again.
  FrameReport restore(const StopFlag* stop = nullptr);
  /// The picture of the last draw() or restore() above, as it was cast, or quantised. The latter is the cheap
  /// one on a GPU: it is quantised there. Not to be used after an incomplete frame.
  void fetch(Image& image);
  void fetch(Image8& image);

  /// The same picture, quantised, between the layers of its labels: stays on the GPU. Null with the CPU.
  /// @param layers  of the picture's size. @throws Error (device)
  std::shared_ptr<const DevicePicture> compose(const OverlayLayers& layers);

  /// The same into the caller's image, which is all there is of the picture then: restore() is given the one
  /// that draw() wrote.
  /// @param image  resized to `size`
  FrameReport draw(const FramePlan& plan, ImageSize size, Image& image, const StopFlag* stop = nullptr);
  FrameReport restore(Image& image, const StopFlag* stop = nullptr);
  /// draw() into an image of its own.
  Image render(ImageSize size, const FramePlan& plan = {}, FrameReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Checks that an isosurface can show something of a volume or of the series that it belongs to.
/// @throws Error (bad_input) that says what the values are: for indices, and for a value that is neither
/// among the volume's own nor in the range of its series
void checkIsoValue(double value, const volume::DenseVolume& volume);

}  // namespace emscape::render
