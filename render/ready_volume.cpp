#include "render/ready_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"

namespace emscape::render {
namespace {

void checkSize(const volume::DenseVolume& volume) {
  const Dims& dims = volume.grid.dims;
  if (dims.x < 1 || dims.y < 1 || dims.z < 1 ||
      dims.count() != static_cast<long long>(volume.values.size())) {
    throw Error(ErrorCode::bad_input, fmt::format("volume of {} x {} x {} voxels holds {} values", dims.x,
                                                  dims.y, dims.z, volume.values.size()));
  }
}

bool allFinite(const float* values, int count) {
  int others = 0;
  for (int i = 0; i < count; ++i) others += values[i] - values[i] != 0.0F ? 1 : 0;
  return others == 0;
}

}  // namespace

void ReadyVolume::set(std::shared_ptr<const volume::DenseVolume> volume) {
  checkSize(*volume);
  volume_ = std::move(volume);
  const auto& mask = volume_->first_valid_k;
  masked_below_ = mask.empty() ? 0 : *std::max_element(mask.begin(), mask.end());
  if (masked_below_ > 0) fillBelowMask();
  const volume::DenseVolume& shown = masked_below_ > 0 ? filled_ : *volume_;
  if (bricks_) {
    bricks_->update(shown);
  } else {
    bricks_.emplace(shown);
  }
  const volume::BricksView bricks = bricks_->view();
  highest_ = -std::numeric_limits<float>::infinity();
  for (long long i = 0; i < bricks.dims.count(); ++i) highest_ = std::max(highest_, bricks.ranges[i].max);

  std::atomic<bool> all_finite{true};
  const int layer = shown.grid.dims.x * shown.grid.dims.y;
  parallelFor(shown.grid.dims.z, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      if (!allFinite(&shown.values[static_cast<std::size_t>(k) * layer], layer)) all_finite = false;
    }
  });
  all_finite_ = all_finite;
}

void ReadyVolume::fillBelowMask() {
  filled_.grid = volume_->grid;
  filled_.values.resize(volume_->values.size());
  filled_.first_valid_k = volume_->first_valid_k;
  first_valid_k_.assign(volume_->first_valid_k.begin(), volume_->first_valid_k.end());
  const Dims dims = volume_->grid.dims;
  parallelFor(dims.y, 4, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const std::int32_t* first_valid = &first_valid_k_[static_cast<std::size_t>(j) * dims.x];
      for (int k = dims.z - 1; k >= 0; --k) {
        const std::size_t row = static_cast<std::size_t>(volume_->grid.index(0, j, k));
        const float* from = &volume_->values[row];
        float* to = &filled_.values[row];
        if (k >= masked_below_ || k == dims.z - 1) {
          std::copy(from, from + dims.x, to);
          continue;
        }
        const float* above = to + static_cast<std::size_t>(dims.x) * dims.y;
        for (int i = 0; i < dims.x; ++i) to[i] = k < first_valid[i] ? above[i] : from[i];
      }
    }
  });
}

VolumeView ReadyVolume::view() const {
  if (masked_below_ == 0) return {volume_->values.data(), volume_->grid.dims, nullptr, 0, all_finite_};
  return {filled_.values.data(), volume_->grid.dims, first_valid_k_.data(), masked_below_, all_finite_};
}

}  // namespace emscape::render
