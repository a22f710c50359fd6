#include "emscape/volume/dense_volume.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "volume/description_check.h"

namespace emscape::volume {

bool operator==(const VolumeInfo& a, const VolumeInfo& b) {
  const auto fields = [](const VolumeInfo& info) {
    return std::tie(info.quantity, info.unit, info.time_s, info.time_utc, info.floor, info.range_min,
                    info.range_max, info.categorical, info.extra);
  };
  return fields(a) == fields(b);
}
namespace {

std::string dimsText(const Dims& dims) {
  return std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " + std::to_string(dims.z);
}

}  // namespace

void checkDims(const Dims& dims, const SourceLocation& location, const std::string& who) {
  // Each factor fits 16 bits, so the product cannot overflow.
  const auto allowed = [](int count) { return count >= 1 && count <= kMaxVoxelsPerAxis; };
  if (!allowed(dims.x) || !allowed(dims.y) || !allowed(dims.z)) {
    throw Error(ErrorCode::bad_input, location,
                who + "dims " + dimsText(dims) + ": each must be 1.." + std::to_string(kMaxVoxelsPerAxis) +
                    " voxels");
  }
  if (dims.count() > kMaxVoxels) {
    throw Error(
        ErrorCode::bad_input, location,
        who + "dims " + dimsText(dims) + ": at most " + std::to_string(kMaxVoxels) + " voxels in all");
  }
}

void checkVolume(const DenseVolume& volume, const SourceLocation& location) {
  const Dims& dims = volume.grid.dims;
  const std::string who = "volume " + volume.info.quantity + ": ";
  const auto fail = [&](const std::string& what) { throw Error(ErrorCode::bad_input, location, who + what); };
  checkGrid(volume.grid, who, location);
  checkInfo(volume.info, who, location);
  if (volume.info.quantity.empty()) fail("a volume needs the name of its quantity");
  if (static_cast<long long>(volume.values.size()) != dims.count()) {
    fail(std::to_string(volume.values.size()) + " values for " + dimsText(dims) + " voxels");
  }
  if (volume.first_valid_k.empty()) return;
  const auto columns = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
  if (volume.first_valid_k.size() != columns) {
    fail("a mask of " + std::to_string(volume.first_valid_k.size()) + " columns for " +
         std::to_string(columns));
  }
  const int highest = *std::max_element(volume.first_valid_k.begin(), volume.first_valid_k.end());
  if (highest > dims.z) {
    fail("a mask that begins at layer " + std::to_string(highest) + " of " + std::to_string(dims.z));
  }
}

std::vector<std::int32_t> toIndices(const DenseVolume& volume, const SourceLocation& location) {
  constexpr float kGreatest = 1 << 24;
  const auto toIndex = [&](float value) {
    if (!(std::abs(value) <= kGreatest) || value != std::floor(value)) {
      throw Error(ErrorCode::bad_input, location,
                  "volume " + volume.info.quantity + ": " + std::to_string(value) +
                      " is not an index; categorical values are whole numbers -16777216..16777216");
    }
    return static_cast<std::int32_t>(value);
  };
  const std::int32_t floor = toIndex(volume.info.floor);
  std::vector<std::int32_t> indices(volume.values.size());
  std::transform(volume.values.begin(), volume.values.end(), indices.begin(),
                 [&](float value) { return std::isnan(value) ? floor : toIndex(value); });
  return indices;
}

}  // namespace emscape::volume
