#include "emscape/volume/volume.h"

#include <utility>

namespace emscape::volume {

Volume::Volume(std::shared_ptr<const DenseVolume> volume) : info_(volume->info), host_(std::move(volume)) {}

Volume::Volume(std::shared_ptr<const DeviceVolume> volume)
    : info_(volume->info), device_(std::move(volume)) {}

Volume::Volume(std::shared_ptr<const DenseVolume> volume, VolumeInfo info)
    : info_(std::move(info)), host_(std::move(volume)) {}

Volume::Volume(std::shared_ptr<const DeviceVolume> volume, VolumeInfo info)
    : info_(std::move(info)), device_(std::move(volume)) {}

Volume::Volume(DenseVolume volume) : Volume(std::make_shared<const DenseVolume>(std::move(volume))) {}

std::shared_ptr<const DenseVolume> Volume::host() const {
  if (host_ && host_->info == info_) return host_;
  auto copy = std::make_shared<DenseVolume>(device_ ? device_->download() : *host_);
  copy->info = info_;
  return copy;
}

}  // namespace emscape::volume
