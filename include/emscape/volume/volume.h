/// One handle for a volume, whether its values are in the host's memory or on a GPU.
#pragma once

#include <memory>

#include "emscape/volume/dense_volume.h"
#include "emscape/volume/device_volume.h"

namespace emscape::volume {

/// Shares the values with whoever else holds them; they do not change while it lives. info() is the handle's
/// own, so that the values of one instant can serve several. Copies are cheap; threads may share one that
/// nobody changes.
class Volume {
 public:
  /// Holds nothing: of its functions only isEmpty() may be called.
  Volume() = default;
  /// @param volume  not null
  Volume(std::shared_ptr<const DenseVolume> volume);
  Volume(std::shared_ptr<const DeviceVolume> volume);
  Volume(const std::shared_ptr<DenseVolume>& volume) : Volume(std::shared_ptr<const DenseVolume>(volume)) {}
  Volume(const std::shared_ptr<DeviceVolume>& volume) : Volume(std::shared_ptr<const DeviceVolume>(volume)) {}
  /// @param info  in place of the volume's own
  Volume(std::shared_ptr<const DenseVolume> volume, VolumeInfo info);
  Volume(std::shared_ptr<const DeviceVolume> volume, VolumeInfo info);
  explicit Volume(DenseVolume volume);

  bool isEmpty() const { return !host_ && !device_; }
  const Grid& grid() const { return device_ ? device_->grid() : host_->grid; }
  const VolumeInfo& info() const { return info_; }
  void setInfo(VolumeInfo info) { info_ = std::move(info); }
  bool isOnDevice() const { return device_ != nullptr; }

  /// The volume in the host's memory, with info(). From a GPU every call copies the values (4 bytes a voxel
  /// over the bus); in the host's memory they are copied only where setInfo() was called.
  /// @throws Error (device)
  std::shared_ptr<const DenseVolume> host() const;
  /// The volume on the GPU, as it was made, without info(); null if it is in the host's memory.
  const std::shared_ptr<const DeviceVolume>& device() const { return device_; }
  /// The volume in the host's memory, as it was made, without info(); null if it is on a GPU.
  const std::shared_ptr<const DenseVolume>& dense() const { return host_; }

 private:
  VolumeInfo info_;
  std::shared_ptr<const DenseVolume> host_;
  std::shared_ptr<const DeviceVolume> device_;
};

}  // namespace emscape::volume
