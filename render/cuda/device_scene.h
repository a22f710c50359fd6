/// What kernels read of a scene, in the GPU's memory. For the neighbours of .cu files.
#pragma once

#include <vector>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/scene.h"
#include "volume/cuda/device_storage.h"

namespace emscape::render::cuda {

/// Copies what has changed, on a stream.
class DeviceScene {
 public:
  /// The volume's values are others than before.
  void volumeChanged() { levels_current_ = false; }
  /// Whether update() has nothing to do. @param scene  prepared
  bool isCurrent(const Scene& scene) const;
  /// @param storage  of the volume, which may be read on the stream
  void update(const Scene& scene, const volume::DeviceStorage& storage, cudaStream_t stream);

  /// To be cast on the device, of what was updated; pixels and layer are left open. Bricks are not looked for
  /// where that does not pay by what is known, which lags a frame behind the volume.
  CastLaunch launch(const Scene& scene, const volume::DeviceStorage& storage, Sampling sampling,
                    ImageSize size) const;

 private:
  void updateTable(const Scene& scene, cudaStream_t stream);
  void updateGround(const Scene& scene, cudaStream_t stream);
  void updateLevels(const Scene& scene, const volume::BricksView& bricks, cudaStream_t stream);

  Scene::Versions seen_;  ///< what the members here were made of

  emscape::cuda::Buffer<Rgba> samples_, projected_, opaque_;
  emscape::cuda::Buffer<HalfColor> half_colors_;
  emscape::cuda::Buffer<int> visible_before_;

  emscape::cuda::Buffer<float> highest_, levels_;
  emscape::cuda::Buffer<BrickSummary> summary_;
  bool levels_current_ = false;
  emscape::cuda::Readback<BrickSummary> found_;  ///< comes after the frame that it was found for
  double skippable_share_ = 1;                   ///< of the bricks, as far as is known

  emscape::cuda::Buffer<float> heights_;
  emscape::cuda::Buffer<Rgba> ground_colors_;
  std::vector<emscape::cuda::Buffer<float>> ground_levels_;
};

}  // namespace emscape::render::cuda
