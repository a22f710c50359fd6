/// A scene in GPU memory, for kernels.
#pragma once

#include <vector>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/scene/scene.h"
#include "volume/cuda/device_storage.h"

namespace emscape::render::cuda {

/// Copies changed data, on a stream.
class DeviceScene {
 public:
  /// Reports that the volume's values have changed.
  void volumeChanged() { levels_current_ = false; }
  /// True if update() has nothing to do. @param scene  prepared
  bool isCurrent(const Scene& scene) const;
  /// @param storage  of the volume, which may be read on the stream
  void update(const Scene& scene, const volume::DeviceStorage& storage, cudaStream_t stream);

  /// The updated scene, for launches; pixels and layer are not set. Whether skipping bricks is worthwhile is
  /// known one frame later.
  CastLaunch launch(const Scene& scene, const volume::DeviceStorage& storage, Sampling sampling,
                    ImageSize size) const;

 private:
  void updateTable(const Scene& scene, cudaStream_t stream);
  void updateGround(const Scene& scene, cudaStream_t stream);
  void updateLevels(const Scene& scene, const volume::BricksView& bricks, cudaStream_t stream);

  Scene::Versions seen_;  ///< from which the members here were made

  emscape::cuda::Buffer<Rgba> samples_, projected_, opaque_;
  emscape::cuda::Buffer<HalfColor> half_colors_;
  emscape::cuda::Buffer<int> visible_before_;

  emscape::cuda::Buffer<float> highest_, levels_;
  emscape::cuda::Buffer<BrickSummary> summary_;
  bool levels_current_ = false;
  emscape::cuda::Readback<BrickSummary> found_;  ///< arrives after the frame for which it was computed
  double skippable_share_ = 1;                   ///< of the bricks, latest known value

  emscape::cuda::Buffer<float> heights_;
  emscape::cuda::Buffer<Rgba> ground_colors_;
  std::vector<emscape::cuda::Buffer<float>> ground_levels_;
};

}  // namespace emscape::render::cuda
