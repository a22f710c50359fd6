/// A volume as the ray casters want it: nothing of what lies below the ground reaches into the air.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "emscape/volume/dense_volume.h"
#include "render/volume_view.h"
#include "volume/bricks.h"

namespace emscape::render {

/// Keeps a volume and what is derived from its values. Memory is kept from one volume to the next of the same
/// grid. Without a mask the values are read where they lie; with one they are copied, and each masked voxel
/// takes the value of the first voxel above it that is not. Finite values are kept in 16 bits too.
class ReadyVolume {
 public:
  /// @throws Error (bad_input) unless the volume holds as many values as voxels
  void set(std::shared_ptr<const volume::DenseVolume> volume);

  bool isSet() const { return volume_ != nullptr; }
  const volume::DenseVolume& volume() const { return *volume_; }
  VolumeView view() const;
  /// Every sample's value lies in its brick's range, whether taken of the values or of the codes.
  volume::BricksView bricks() const;
  float highest() const { return highest_; }  ///< of all values that a sample can have

 private:
  void fillBelowMask();
  void encode(const volume::DenseVolume& shown);

  std::shared_ptr<const volume::DenseVolume> volume_;
  volume::DenseVolume filled_;  ///< used where a voxel is masked
  std::vector<std::int32_t> first_valid_k_;
  int masked_below_ = 0;
  std::optional<volume::Bricks> bricks_;
  std::vector<volume::ValueRange> ranges_;  ///< of the bricks
  float highest_ = 0;
  bool all_finite_ = true;
  std::vector<std::int16_t> codes_;
  CodedValues coded_;
};

}  // namespace emscape::render
