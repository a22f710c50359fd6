/// A volume prepared for ray casting: masked voxels repeat the first value above them, so that interpolation
/// near the ground does not blend in the floor.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "emscape/volume/dense_volume.h"
#include "render/cast/volume_view.h"
#include "volume/bricks.h"

namespace emscape::render {

/// Keeps a volume and the data derived from its values. Memory is reused for the next volume of the same
/// grid. Values without a mask are read in place; values with one are copied. Finite values are also kept in
/// 16 bits.
class PreparedVolume {
 public:
  /// @throws Error (bad_input) unless the volume has one value per voxel
  void set(std::shared_ptr<const volume::DenseVolume> volume);

  bool isSet() const { return volume_ != nullptr; }
  const volume::DenseVolume& volume() const { return *volume_; }
  VolumeView view() const;
  /// Every sample is within its brick's range, read from the values or from the codes.
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
  QuantizedValues coded_;
};

}  // namespace emscape::render
