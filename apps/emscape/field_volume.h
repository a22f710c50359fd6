/// A volume in whatever memory it was computed or read.
#pragma once

#include <memory>

#include "volume/dense_volume.h"
#include "volume/device_volume.h"

namespace emscape::app {

/// In the host's memory or on a GPU; there its values stay until a file needs them. Threads may share it.
class FieldVolume {
 public:
  FieldVolume() = default;
  /// @param info  in the place of the volume's own: of a volume that serves several instants
  FieldVolume(std::shared_ptr<const volume::DenseVolume> volume, volume::VolumeInfo info)
      : info_(std::move(info)), host_(std::move(volume)) {}
  FieldVolume(std::shared_ptr<const volume::DeviceVolume> volume, volume::VolumeInfo info)
      : info_(std::move(info)), device_(std::move(volume)) {}

  const volume::VolumeInfo& info() const { return info_; }
  void setInfo(volume::VolumeInfo info) { info_ = std::move(info); }
  const volume::Grid& grid() const { return device_ ? device_->grid() : host_->grid; }

  /// A copy in the host's memory. @throws Error (device)
  volume::DenseVolume copy() const {
    volume::DenseVolume copied = device_ ? device_->download() : *host_;
    copied.info = info_;
    return copied;
  }

  /// Calls `take` with a pointer to the volume as it lies in memory; its info is not info().
  template <class Take>
  void give(const Take& take) const {
    if (device_) {
      take(device_);
    } else {
      take(host_);
    }
  }

 private:
  volume::VolumeInfo info_;
  std::shared_ptr<const volume::DenseVolume> host_;
  std::shared_ptr<const volume::DeviceVolume> device_;
};

}  // namespace emscape::app
