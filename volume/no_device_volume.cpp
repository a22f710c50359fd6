/// Device volumes in a build without CUDA: there are none.
#include "emscape/base/error.h"
#include "emscape/volume/device_volume.h"

namespace emscape::volume {

class DeviceStorage {};

namespace {

[[noreturn]] void refuse() {
  throw Error(ErrorCode::device, "a volume on the GPU: this build has no CUDA");
}

}  // namespace

DeviceVolume::DeviceVolume(const Grid& grid, VoxelPrecision precision) : grid_(grid), precision_(precision) {
  refuse();
}
DeviceVolume::~DeviceVolume() = default;
std::size_t DeviceVolume::bytes() const {
  refuse();
}
void DeviceVolume::setMask(const std::vector<std::uint16_t>& /*first_valid_k*/) {
  refuse();
}
void DeviceVolume::upload(const DenseVolume& /*volume*/) {
  refuse();
}
DenseVolume DeviceVolume::download() const {
  refuse();
}
std::shared_ptr<const float> DeviceVolume::linearCopy() const {
  refuse();
}

}  // namespace emscape::volume
