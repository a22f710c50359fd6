/// A volume as the ray caster reads it: plain data, sampling, and the bricks that need no sampling.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/host_device.h"
#include "base/vec.h"
#include "volume/bricks.h"

namespace emscape::render {

/// The values of a volume once more, in 16 bits: what the processor's vectors of rays gather, as half as much
/// memory streams by. A value is middle + step * code.
struct CodedValues {
  /// Widest sum of two neighbours' codes with weights that add up to it, in 32 bits.
  static constexpr std::int32_t kWeights = 32767;
  static constexpr std::int32_t kLargest = 32767;  ///< codes are -kLargest..kLargest

  const std::int16_t* codes = nullptr;  ///< as VolumeView::values; null: there are none
  float middle = 0;
  float step_per_weight = 0;  ///< step / kWeights

  /// A value from a code times kWeights, or from neighbours' codes times weights that add up to it.
  EMSCAPE_HD float value(float weighted_code) const { return fmaf(weighted_code, step_per_weight, middle); }
  EMSCAPE_HD float step() const { return step_per_weight * static_cast<float>(kWeights); }
};

/// Values as a ReadyVolume holds them. Positions are in index space: voxel (i, j, k) has its centre at
/// (i, j, k).
struct VolumeView {
  const float* values = nullptr;  ///< masked voxels hold the value of the first above them that is not
  Dims dims;
  const std::int32_t* first_valid_k = nullptr;  ///< one a column; null: no voxel is masked
  int masked_below = 0;                         ///< no voxel of a layer from here up is masked
  bool all_finite = true;                       ///< no value is NaN or infinite
  std::uint64_t texture = 0;                    ///< on a GPU: of the values, which are null then
  CodedValues coded;

  EMSCAPE_HD Vec3d lower() const { return {-0.5, -0.5, -0.5}; }
  EMSCAPE_HD Vec3d upper() const { return {dims.x - 0.5, dims.y - 0.5, dims.z - 0.5}; }
  EMSCAPE_HD bool isMasked(int i, int j, int k) const {
    return k < masked_below && k < first_valid_k[static_cast<long long>(j) * dims.x + i];
  }
  EMSCAPE_HD float at(int i, int j, int k) const {
    return values[(static_cast<long long>(k) * dims.y + j) * dims.x + i];
  }
};

/// A position along one axis, held inside the centres of the outer voxels, and the cell of two voxels around
/// it.
struct CellPosition {
  int low = 0, high = 0;
  float fraction = 0;

  EMSCAPE_HD CellPosition(float position, int count) {
    const float last = static_cast<float>(count - 1);
    const float held = position > 0.0F ? (position < last ? position : last) : 0.0F;
    low = static_cast<int>(held);
    high = low + 1 < count ? low + 1 : low;
    fraction = held - static_cast<float>(low);
  }
  EMSCAPE_HD int nearest() const { return fraction < 0.5F ? low : high; }
};

EMSCAPE_HD inline float lerp(float a, float b, float fraction) {
  return a + fraction * (b - a);
}

/// Voxels of an array.
struct ArrayVoxels {
  EMSCAPE_HD static float at(const VolumeView& volume, int i, int j, int k) { return volume.at(i, j, k); }
};

/// Trilinear between voxel centres. Nothing is drawn where the nearest voxel is masked; elsewhere what lies
/// below ground does not bleed into the air, as masked voxels hold the value above them. NaN draws nothing.
template <class Voxels>
struct TrilinearSamplerOf {
  EMSCAPE_HD static bool sample(const VolumeView& volume, const Vec3f& position, float& value) {
    const CellPosition x(position.x, volume.dims.x);
    const CellPosition y(position.y, volume.dims.y);
    const CellPosition z(position.z, volume.dims.z);
    if (z.low < volume.masked_below && volume.isMasked(x.nearest(), y.nearest(), z.nearest())) return false;
    const auto row = [&](int j, int k) {
      return lerp(Voxels::at(volume, x.low, j, k), Voxels::at(volume, x.high, j, k), x.fraction);
    };
    const float below = lerp(row(y.low, z.low), row(y.high, z.low), y.fraction);
    const float above = lerp(row(y.low, z.high), row(y.high, z.high), y.fraction);
    value = lerp(below, above, z.fraction);
    return value == value;
  }
};
using TrilinearSampler = TrilinearSamplerOf<ArrayVoxels>;

/// The value of the nearest voxel, for indices. Masked voxels and NaN draw nothing.
template <class Voxels>
struct NearestSamplerOf {
  EMSCAPE_HD static bool sample(const VolumeView& volume, const Vec3f& position, float& value) {
    const int i = CellPosition(position.x, volume.dims.x).nearest();
    const int j = CellPosition(position.y, volume.dims.y).nearest();
    const int k = CellPosition(position.z, volume.dims.z).nearest();
    if (volume.isMasked(i, j, k)) return false;
    value = Voxels::at(volume, i, j, k);
    return value == value;
  }
};
using NearestSampler = NearestSamplerOf<ArrayVoxels>;

/// A sample, or NaN where nothing is drawn.
template <class Sampler>
EMSCAPE_HD float sampleOrNaN(const VolumeView& volume, const Vec3f& position) {
  float value = 0;
  return Sampler::sample(volume, position, value) ? value : NAN;
}

/// What a ray finds of the brick around a position.
struct BrickStep {
  long long index = 0;
  float leave = 0;  ///< voxels along the ray that surely stay in it
};

/// Which bricks need no sampling, for the transfer function and the mode in force.
struct SkipView {
  static constexpr int kEdgeBits = 3;
  static constexpr float kNever = 2.0F;
  /// Samples nearer to a face (voxels) than rounding can tell apart are looked at anew.
  static constexpr float kFaceMargin = 1e-3F;

  const float* highest = nullptr;  ///< one a brick: no f of a sample in it is larger
  /// The same, but kNever where some sample in it has an opacity (except in maximum projection, where opacity
  /// does not matter). For an isosurface: kNever where samples lie on both sides of it. Null: nothing is
  /// skipped.
  const float* levels = nullptr;
  Dims dims;

  /// Brick along one axis and the distance to its far face; the outer bricks reach to infinity.
  EMSCAPE_HD int along(float position, float direction, int voxels, int bricks, float& leave) const {
    const int brick = CellPosition(position, voxels).low >> kEdgeBits;
    const bool forward = direction > 0.0F;
    if (direction == 0.0F || (forward ? brick + 1 >= bricks : brick <= 0)) return brick;
    const float face = static_cast<float>((forward ? brick + 1 : brick) << kEdgeBits);
    const float distance = (face - position) / direction;
    if (distance < leave) leave = distance;
    return brick;
  }

  EMSCAPE_HD BrickStep at(const VolumeView& volume, const Vec3f& position, const Vec3f& direction) const {
    float leave = 1e9F;
    const int x = along(position.x, direction.x, volume.dims.x, dims.x, leave);
    const int y = along(position.y, direction.y, volume.dims.y, dims.y, leave);
    const int z = along(position.z, direction.z, volume.dims.z, dims.z, leave);
    const float sure = leave - kFaceMargin;
    return {(static_cast<long long>(z) * dims.y + y) * dims.x + x, sure > 0.0F ? sure : 0.0F};
  }
};

}  // namespace emscape::render
