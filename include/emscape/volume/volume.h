/// A handle to a volume, whose values are in host memory or on a GPU.
#pragma once

#include <memory>

#include "emscape/volume/dense_volume.h"
#include "emscape/volume/device_volume.h"

namespace emscape::volume {

/// Shares ownership of the values, which do not change during its lifetime. info() belongs to the handle, so
/// that several handles can share values. Copies are cheap; threads may share a handle that is not changed.
class Volume {
 public:
  /// Empty: only isEmpty() may be called.
  Volume() = default;
  /// @param volume  not null
  Volume(std::shared_ptr<const DenseVolume> volume);
  Volume(std::shared_ptr<const DeviceVolume> volume);
  Volume(const std::shared_ptr<DenseVolume>& volume) : Volume(std::shared_ptr<const DenseVolume>(volume)) {}
  Volume(const std::shared_ptr<DeviceVolume>& volume) : Volume(std::shared_ptr<const DeviceVolume>(volume)) {}
  /// @param info  replaces the volume's own
  Volume(std::shared_ptr<const DenseVolume> volume, VolumeInfo info);
  Volume(std::shared_ptr<const DeviceVolume> volume, VolumeInfo info);
  explicit Volume(DenseVolume volume);

  bool isEmpty() const { return !host_ && !device_; }
  const Grid& grid() const { return device_ ? device_->grid() : host_->grid; }
  const VolumeInfo& info() const { return info_; }
  void setInfo(VolumeInfo info) { info_ = std::move(info); }
  bool isOnDevice() const { return device_ != nullptr; }

  /// The volume in host memory, with info(). From a GPU every call copies the values (4 bytes per voxel over
  /// the bus); in host memory only a call after setInfo() copies them.
  /// @throws Error (device)
  std::shared_ptr<const DenseVolume> host() const;
  /// The volume on the GPU, with its original info; null if it is in host memory.
  const std::shared_ptr<const DeviceVolume>& device() const { return device_; }
  /// The volume in host memory, with its original info; null if it is on a GPU.
  const std::shared_ptr<const DenseVolume>& dense() const { return host_; }

 private:
  VolumeInfo info_;
  std::shared_ptr<const DenseVolume> host_;
  std::shared_ptr<const DeviceVolume> device_;
};

}  // namespace emscape::volume
