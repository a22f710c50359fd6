#include <string>

#include "emscape/volume/device_volume.h"
#include "volume/cuda/device_storage.h"
#include "volume/nvdb/nanovdb_grid.h"

namespace emscape::volume {

DeviceVolume::DeviceVolume(const Grid& grid, VoxelPrecision precision)
    : grid_(grid), precision_(precision), storage_(std::make_unique<DeviceStorage>(grid.dims, precision)) {}
DeviceVolume::~DeviceVolume() = default;

std::size_t DeviceVolume::bytes() const {
  return deviceBytes(grid_.dims, precision_) + storage_->sparseBytes();
}

void DeviceVolume::setMask(const std::vector<std::uint16_t>& first_valid_k) {
  if (first_valid_k == first_valid_k_) return;
  const std::size_t columns = static_cast<std::size_t>(grid_.dims.x) * static_cast<std::size_t>(grid_.dims.y);
  if (!first_valid_k.empty() && first_valid_k.size() != columns) {
    throw Error(ErrorCode::bad_input, "volume " + info.quantity + ": a mask of " +
                                          std::to_string(first_valid_k.size()) + " columns for " +
                                          std::to_string(columns));
  }
  storage_->setMask(first_valid_k);
  first_valid_k_ = first_valid_k;
}

void DeviceVolume::upload(const DenseVolume& volume) {
  checkVolume(volume, {});
  if (volume.grid.dims != grid_.dims) {
    throw Error(ErrorCode::bad_input,
                "volume " + volume.info.quantity + ": its dims are not those on the GPU");
  }
  info = volume.info;
  setMask(volume.first_valid_k);
  const emscape::cuda::Stream stream;
  storage_->beginWriting(stream);
  if (precision_ == VoxelPrecision::sparse32) {
    const nano::Handle grid = toNano(readyForSampling(volume), {});
    storage_->setSparse(grid.data(), grid.size(), stream);
  } else {
    storage_->writeFrom(volume.values.data(), stream);
  }
  storage_->endWriting(stream);
  stream.wait();
}

DenseVolume DeviceVolume::download() const {
  DenseVolume volume;
  volume.grid = grid_;
  volume.info = info;
  volume.first_valid_k = first_valid_k_;
  volume.values.resize(static_cast<std::size_t>(grid_.dims.count()));
  const emscape::cuda::Stream stream;
  storage_->beginReading(stream);
  storage_->readTo(volume.values.data(), info.floor, stream);
  storage_->endReading(stream);
  return volume;
}

std::shared_ptr<const float> DeviceVolume::linearCopy() const {
  const auto copy =
      std::make_shared<emscape::cuda::Buffer<float>>(static_cast<std::size_t>(grid_.dims.count()));
  const emscape::cuda::Stream stream;
  storage_->beginReading(stream);
  storage_->copyTo(copy->data(), info.floor, stream);
  storage_->endReading(stream);
  stream.wait();
  return {copy, copy->data()};
}

}  // namespace emscape::volume
