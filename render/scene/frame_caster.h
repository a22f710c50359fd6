/// Interface between a renderer and the processor that casts its pictures; implemented for the CPU and for
/// CUDA.
#pragma once

#include <memory>

#include "emscape/base/progress.h"
#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/frame.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/device_volume.h"
#include "render/scene/scene.h"

namespace emscape::render {

/// Casts frames and keeps the last picture in the memory in which it was cast. For one thread.
class FrameCaster {
 public:
  virtual ~FrameCaster() = default;

  virtual void setVolume(std::shared_ptr<const volume::DenseVolume> volume) = 0;
  virtual void setVolume(std::shared_ptr<const volume::DeviceVolume> volume) = 0;

  /// See Renderer.
  virtual std::size_t volumeBytes() const = 0;

  /// See Renderer. @param scene  prepared, for the last volume that was set
  virtual FrameReport draw(const Scene& scene, const FramePlan& plan, ImageSize size,
                           const StopFlag* stop) = 0;
  virtual FrameReport restore(const Scene& scene, const StopFlag* stop, Edges edges) = 0;

  /// Called before and after a frame whose picture the caller wants in its own image: the CPU casts into it.
  virtual void bindTarget(Image& image) = 0;
  virtual void unbindTarget(Image& image, const FrameReport& report) = 0;
  /// The picture of the last frame.
  virtual void fetch(Image& image) = 0;
  virtual void fetch(Image8& image) = 0;
  /// See Renderer.
  virtual std::shared_ptr<const DevicePicture> compose(const OverlayLayers& /*layers*/) { return nullptr; }
};

/// With all threads of the CPU.
std::unique_ptr<FrameCaster> makeCpuCaster();
/// With the GPU. @param precision  of volumes that come from the host's memory
/// @throws Error (device) if there is none, or none was built in
std::unique_ptr<FrameCaster> makeCudaCaster(volume::VoxelPrecision precision);

}  // namespace emscape::render
