#include "render/scene/prepared_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/math/simd.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

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

/// Codes of a run of values. A value outside the codes' range, which no sample reaches, gets the nearest
/// code.
/// @return whether all values are finite
EMSCAPE_SIMD_CLONES bool encodeRun(const float* values, int count, const QuantizedValues& coded,
                                   std::int16_t* codes) {
  const float middle = coded.middle;
  const float codes_per_unit = coded.step_per_weight > 0.0F ? 1.0F / coded.step() : 0.0F;
  constexpr float kMaxCode = QuantizedValues::kMaxCode;
  int others = 0;
  for (int i = 0; i < count; ++i) {
    const float from_middle = values[i] - middle;
    others += from_middle - from_middle != 0.0F ? 1 : 0;
    float code = from_middle * codes_per_unit;
    code = code > -kMaxCode ? code : -kMaxCode;  // NaN too
    code = code < kMaxCode ? code : kMaxCode;
    // The converted number is positive, so that truncation rounds it.
    codes[i] =
        static_cast<std::int16_t>(static_cast<int>(code + kMaxCode + 0.5F) - QuantizedValues::kMaxCode);
  }
  return others == 0;
}

}  // namespace

void PreparedVolume::set(std::shared_ptr<const volume::DenseVolume> volume) {
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
  encode(shown);
}

void PreparedVolume::encode(const volume::DenseVolume& shown) {
  const volume::BricksView bricks = bricks_->view();
  ranges_.assign(bricks.ranges, bricks.ranges + bricks.dims.count());
  float lowest = std::numeric_limits<float>::infinity();
  highest_ = -lowest;
  for (const volume::ValueRange& range : ranges_) {
    lowest = std::min(lowest, range.min);
    highest_ = std::max(highest_, range.max);
  }
  // Of halves, as the difference of two floats can be infinite.
  coded_.middle = 0.5F * lowest + 0.5F * highest_;
  const float step = (highest_ - coded_.middle) / QuantizedValues::kMaxCode;
  coded_.step_per_weight = step / QuantizedValues::kWeights;
  const bool too_small = highest_ > lowest && !(coded_.step_per_weight >= std::numeric_limits<float>::min());

  codes_.resize(shown.values.size());
  std::atomic<bool> all_finite{true};
  const int layer = shown.grid.dims.x * shown.grid.dims.y;
  parallelFor(shown.grid.dims.z, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::size_t first = static_cast<std::size_t>(k) * layer;
      if (!encodeRun(&shown.values[first], layer, coded_, &codes_[first])) all_finite = false;
    }
  });
  all_finite_ = all_finite;
  coded_.codes = all_finite_ && !too_small ? codes_.data() : nullptr;
  if (coded_.codes == nullptr) return;

  // Codes are rounded, so that a sampled code may be outside the range of its brick's values.
  const auto coded = [&](float value) {
    std::int16_t code = 0;
    encodeRun(&value, 1, coded_, &code);
    return coded_.value(static_cast<float>(code * QuantizedValues::kWeights));
  };
  for (volume::ValueRange& range : ranges_) {
    if (range.empty()) continue;
    range = {std::min(range.min, coded(range.min)), std::max(range.max, coded(range.max))};
    highest_ = std::max(highest_, range.max);
  }
}

void PreparedVolume::fillBelowMask() {
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

volume::BricksView PreparedVolume::bricks() const {
  volume::BricksView bricks = bricks_->view();
  bricks.ranges = ranges_.data();
  return bricks;
}

VolumeView PreparedVolume::view() const {
  VolumeView view;
  view.values = masked_below_ > 0 ? filled_.values.data() : volume_->values.data();
  view.dims = volume_->grid.dims;
  view.first_valid_k = masked_below_ > 0 ? first_valid_k_.data() : nullptr;
  view.masked_below = masked_below_;
  view.all_finite = all_finite_;
  view.coded = coded_;
  return view;
}

}  // namespace emscape::render
