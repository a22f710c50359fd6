/// A volume for the ray caster: plain data, sampling, and the bricks that need no sampling.
#pragma once

#include <cstdint>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "volume/bricks.h"
#include "volume/sparse/sparse_tiles.h"

namespace emscape::render {

/// The values of a volume quantized to 16 bits, for the gathers of the CPU's ray packets: half the memory
/// traffic. A value is middle + step * code.
struct QuantizedValues {
  /// Widest sum of two neighbours' codes with weights that add up to it, in 32 bits.
  static constexpr std::int32_t kWeights = 32767;
  static constexpr std::int32_t kMaxCode = 32767;  ///< codes are -kMaxCode..kMaxCode

  const std::int16_t* codes = nullptr;  ///< as VolumeView::values; null: none
  float middle = 0;
  float step_per_weight = 0;  ///< step / kWeights

  /// A value from a code times kWeights, or from neighbours' codes times weights that add up to it.
  EMSCAPE_HD float value(float weighted_code) const { return fmaf(weighted_code, step_per_weight, middle); }
  EMSCAPE_HD float step() const { return step_per_weight * static_cast<float>(kWeights); }
};

/// Values of a PreparedVolume. Positions are in index space: voxel (i, j, k) has its centre at (i, j, k).
struct VolumeView {
  const float* values = nullptr;  ///< masked voxels have the value of the first unmasked voxel above them
  Dims dims;
  const std::int32_t* first_valid_k = nullptr;  ///< one per column; null: no voxel is masked
  int masked_below = 0;                         ///< no voxel of a layer from here up is masked
  bool all_finite = true;                       ///< no value is NaN or infinite
  std::uint64_t texture = 0;                    ///< on a GPU: texture of the values; `values` is then null
  const volume::SparseTile* tiles = nullptr;    ///< of a sparse volume: `texture` is their atlas
  QuantizedValues coded;

  EMSCAPE_HD Vec3d lower() const { return {-0.5, -0.5, -0.5}; }
  EMSCAPE_HD Vec3d upper() const { return {dims.x - 0.5, dims.y - 0.5, dims.z - 0.5}; }
  EMSCAPE_HD bool isMasked(int i, int j, int k) const {
    return k < masked_below && k < first_valid_k[static_cast<long long>(j) * dims.x + i];
  }
  EMSCAPE_HD float at(int i, int j, int k) const {
    return values[(static_cast<long long>(k) * dims.y + j) * dims.x + i];
  }
};

/// A position along one axis, clamped to the centres of the outer voxels, and the cell of two voxels around
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

/// Voxels of an array.
struct ArrayVoxels {
  const VolumeView& volume;
  EMSCAPE_HD explicit ArrayVoxels(const VolumeView& of) : volume(of) {}
  EMSCAPE_HD float at(int i, int j, int k) const { return volume.at(i, j, k); }
};

/// True if the voxel nearest to a position is masked.
EMSCAPE_HD inline bool nearestIsMasked(const VolumeView& volume, const Vec3f& position) {
  if (volume.masked_below == 0 || !(position.z < static_cast<float>(volume.masked_below))) return false;
  return volume.isMasked(CellPosition(position.x, volume.dims.x).nearest(),
                         CellPosition(position.y, volume.dims.y).nearest(),
                         CellPosition(position.z, volume.dims.z).nearest());
}

/// Common parts of samplers. Nothing is drawn where the nearest voxel is masked or the value is NaN. Sampler:
/// fetch(volume, shifted) returns the value, masked or not; kShift must be added to each coordinate before.
template <class Sampler>
struct SamplerOf {
  static constexpr float kShift = 0;

  /// @return true if something is drawn there
  EMSCAPE_HD static bool sample(const VolumeView& volume, const Vec3f& position, float& value) {
    if (nearestIsMasked(volume, position)) return false;
    const float shift = Sampler::kShift;
    value = Sampler::fetch(volume, position + Vec3f{shift, shift, shift});
    return value == value;
  }
};

/// Trilinear between voxel centres. The floor below the ground does not blend in, because masked voxels have
/// the value above them.
template <class Voxels>
struct TrilinearSamplerOf : SamplerOf<TrilinearSamplerOf<Voxels>> {
  EMSCAPE_HD static float fetch(const VolumeView& volume, const Vec3f& position) {
    const CellPosition x(position.x, volume.dims.x);
    const CellPosition y(position.y, volume.dims.y);
    const CellPosition z(position.z, volume.dims.z);
    const Voxels voxels(volume);
    const auto row = [&](int j, int k) {
      return lerp(voxels.at(x.low, j, k), voxels.at(x.high, j, k), x.fraction);
    };
    const float below = lerp(row(y.low, z.low), row(y.high, z.low), y.fraction);
    const float above = lerp(row(y.low, z.high), row(y.high, z.high), y.fraction);
    return lerp(below, above, z.fraction);
  }
};
using TrilinearSampler = TrilinearSamplerOf<ArrayVoxels>;

/// The value of the nearest voxel, for indices.
template <class Voxels>
struct NearestSamplerOf : SamplerOf<NearestSamplerOf<Voxels>> {
  EMSCAPE_HD static float fetch(const VolumeView& volume, const Vec3f& position) {
    return Voxels(volume).at(CellPosition(position.x, volume.dims.x).nearest(),
                             CellPosition(position.y, volume.dims.y).nearest(),
                             CellPosition(position.z, volume.dims.z).nearest());
  }
};
using NearestSampler = NearestSamplerOf<ArrayVoxels>;

/// The brick around a position of a ray.
struct BrickStep {
  long long index = 0;
  float leave = 0;  ///< voxels along the ray that are certainly inside it
};

/// The bricks that need no sampling, for the present transfer function and mode.
struct SkipView {
  static constexpr int kEdgeBits = 3;
  static constexpr float kNever = 2.0F;
  /// Samples within this distance (voxels) of a face, in the order of rounding errors, are tested again.
  static constexpr float kFaceMargin = 1e-3F;

  const float* highest = nullptr;  ///< one per brick: upper bound of f of its samples
  /// The same, but kNever if some sample in it has an opacity (except in maximum projection, where opacity
  /// does not matter). For an isosurface: kNever if samples are on both sides of it. Null: nothing is
  /// skipped.
  const float* levels = nullptr;
  Dims dims;

  /// Brick along one axis and the distance to its far face; the outer bricks reach to infinity.
  /// @param per_voxel  distance along the ray per voxel of the axis; infinite: perpendicular to the axis
  EMSCAPE_HD int along(float position, float per_voxel, int voxels, int bricks, float& leave) const {
    const int brick = CellPosition(position, voxels).low >> kEdgeBits;
    const bool forward = per_voxel > 0.0F;
    if (per_voxel - per_voxel != 0.0F || (forward ? brick + 1 >= bricks : brick <= 0)) return brick;
    const float face = static_cast<float>((forward ? brick + 1 : brick) << kEdgeBits);
    const float distance = (face - position) * per_voxel;
    if (distance < leave) leave = distance;
    return brick;
  }

  /// @param per_voxel  1 / direction of the ray
  EMSCAPE_HD BrickStep at(const VolumeView& volume, const Vec3f& position, const Vec3f& per_voxel) const {
    float leave = 1e9F;
    const int x = along(position.x, per_voxel.x, volume.dims.x, dims.x, leave);
    const int y = along(position.y, per_voxel.y, volume.dims.y, dims.y, leave);
    const int z = along(position.z, per_voxel.z, volume.dims.z, dims.z, leave);
    const float sure = leave - kFaceMargin;
    return {(static_cast<long long>(z) * dims.y + y) * dims.x + x, sure > 0.0F ? sure : 0.0F};
  }
};

}  // namespace emscape::render
