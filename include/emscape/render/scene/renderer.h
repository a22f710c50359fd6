/// Draws volumes; keeps its state between frames.
#pragma once

#include <memory>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/frame.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/volume.h"

namespace emscape::render {

/// Backend and storage of a renderer.
struct RendererOptions {
  Backend backend = Backend::cpu;  ///< automatic: the GPU if a usable one exists, else the CPU
  /// Storage on a GPU of volumes from host memory; sparse32: of all volumes
  volume::VoxelPrecision precision = volume::VoxelPrecision::float32;
};

/// Casts a scene: volume, ground, transfer function, camera. A pixel of a scene depends only on its
/// coordinates and the picture's size, not on the pattern; a smoothed one also on the picture around it.
///
/// For one thread, except setVolume(), which any thread may call at any time: it waits for the frame in
/// progress. On the CPU a frame uses all threads that base/parallel.h allows. On a GPU it is cast on a
/// separate stream, while the next volume may be written on another one.
class Renderer {
 public:
  /// With Backend::automatic one line of the log states the choice and the reason.
  /// @throws Error (device) if cuda is requested and there is none
  explicit Renderer(const RendererOptions& options = {});
  ~Renderer();

  /// cpu or cuda.
  Backend backend() const;

  /// Sets the volume. Values in the renderer's memory (host memory for the CPU, GPU memory for the GPU) are
  /// read in place; reads and writes on a GPU wait for each other. Values in the other memory are copied.
  /// Cheap if the grid stays the same.
  /// @throws Error (other) for an empty handle, (device) if a copy does not fit
  void setVolume(const volume::Volume& volume);
  /// GPU memory of the volume (bytes); 0 on the CPU.
  std::size_t volumeBytes() const;
  /// Null: no ground is drawn. @throws Error (bad_input) for an impossible field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// @throws Error (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const RenderSettings& settings() const;
  const TransferFunction& transferFunction() const;
  /// The value of the isosurface in mode iso.
  double isoValue() const;
  const Camera& camera() const;
  /// The box of the volume as drawn. A volume must be set.
  SceneBox sceneBox() const;
  /// True if a position (frame metres) is on the removed side of a plane, or is hidden from the camera by the
  /// ground or by a section with a value; on a GPU all sections are taken to have one. A volume must be set.
  bool isHidden(const Vec3d& frame_m) const;

  /// Draws a frame of the scene: casts the pixels of the plan's pattern and interpolates the others. The
  /// picture stays in the memory in which it was cast.
  /// @param stop  set by another thread: draw() returns soon with an incomplete picture. May be null
  /// @throws Error (device)
  FrameReport draw(const FramePlan& plan, ImageSize size, const StopFlag* stop = nullptr);
  /// Casts the pixels that the last draw() interpolated. The picture is then bit-identical to a full cast of
  /// the same scene, which must not have changed in between. A stopped restoration starts again from the
  /// beginning.
  FrameReport restore(const StopFlag* stop = nullptr, Edges edges = Edges::as_cast);
  /// The picture of the last draw() or restore(), in float or quantised. The latter is cheaper on a GPU,
  /// which quantises it. Not to be used after an incomplete frame.
  void fetch(Image& image);
  void fetch(Image8& image);

  /// The same picture, quantised, between the layers of its labels; stays on the GPU. Null on the CPU.
  /// @param layers  of the picture's size. @throws Error (device)
  std::shared_ptr<const DevicePicture> compose(const OverlayLayers& layers);

  /// draw() and restore() with the caller's image; no other copy is kept. restore() needs the image that
  /// draw() wrote.
  /// @param image  resized to `size`
  FrameReport draw(const FramePlan& plan, ImageSize size, Image& image, const StopFlag* stop = nullptr);
  FrameReport restore(Image& image, const StopFlag* stop = nullptr, Edges edges = Edges::as_cast);
  /// draw() into a new image.
  Image render(ImageSize size, const FramePlan& plan = {}, FrameReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @param range  of the series; none: that of info
/// @return one line with the range of values if an isosurface cannot be visible in a volume or in its series:
/// its value is neither in the range of the volume nor in that of its series; else empty
/// @throws Error (bad_input) for indices
std::string missingIsosurface(double value, const volume::DenseVolume& volume, const ColorRange& range = {});

}  // namespace emscape::render
