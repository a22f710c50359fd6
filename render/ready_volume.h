/// A volume as the ray casters want it: nothing of what lies below the ground reaches into the air.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/volume_view.h"
#include "volume/bricks.h"
#include "volume/dense_volume.h"

namespace emscape::render {

/// Keeps a volume and what is derived from its values. Memory is kept from one volume to the next of the same
/// grid. Without a mask the values are read where they lie; with one they are copied, and each masked voxel
/// takes the value of the first voxel above it that is not.
class ReadyVolume {
 public:
  /// @throws Error (bad_input) unless the volume holds as many values as voxels
  void set(std::shared_ptr<const volume::DenseVolume> volume);

  bool isSet() const { return volume_ != nullptr; }
  const volume::DenseVolume& volume() const { return *volume_; }
  VolumeView view() const;
  volume::BricksView bricks() const { return bricks_->view(); }
  float highest() const { return highest_; }  ///< of all values that a sample can have

 private:
  void fillBelowMask();

  std::shared_ptr<const volume::DenseVolume> volume_;
  volume::DenseVolume filled_;  ///< used where a voxel is masked
  std::vector<std::int32_t> first_valid_k_;
  int masked_below_ = 0;
  std::optional<volume::Bricks> bricks_;
  float highest_ = 0;
  bool all_finite_ = true;
};

}  // namespace emscape::render
