/// Vectors of rays and their inputs: volume, transfer function, bricks. Included once for each instruction
/// set by packets.cpp, after hwy/highway.h.
#if defined(EMSCAPE_RENDER_CPU_PACKET_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EMSCAPE_RENDER_CPU_PACKET_SAMPLING_INL_H_
#undef EMSCAPE_RENDER_CPU_PACKET_SAMPLING_INL_H_
#else
#define EMSCAPE_RENDER_CPU_PACKET_SAMPLING_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include "render/cast/raycast.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using TagF = hn::ScalableTag<float>;
using TagI = hn::ScalableTag<std::int32_t>;
using TagOffset = hn::ScalableTag<std::int64_t>;
using F = hn::Vec<TagF>;
using I = hn::Vec<TagI>;
using D = hn::Vec<hn::ScalableTag<double>>;
using Offset = hn::Vec<TagOffset>;
using M = hn::Mask<TagF>;
constexpr TagF kF;
constexpr TagI kI;

/// One position or direction per lane.
struct Vec3F {
  F x, y, z;

  HWY_INLINE Vec3F along(const Vec3F& direction, F distance) const {
    return {hn::MulAdd(direction.x, distance, x), hn::MulAdd(direction.y, distance, y),
            hn::MulAdd(direction.z, distance, z)};
  }
};

/// One premultiplied colour per lane.
struct Color {
  F r, g, b, a;

  static HWY_INLINE Color zero() { return {hn::Zero(kF), hn::Zero(kF), hn::Zero(kF), hn::Zero(kF)}; }
  HWY_INLINE Color times(F s) const { return {r * s, g * s, b * s, a * s}; }
  /// this + s * other
  HWY_INLINE Color plus(const Color& other, F s) const {
    return {hn::MulAdd(other.r, s, r), hn::MulAdd(other.g, s, g), hn::MulAdd(other.b, s, b),
            hn::MulAdd(other.a, s, a)};
  }
  HWY_INLINE Color where(M mask) const {
    return {hn::IfThenElseZero(mask, r), hn::IfThenElseZero(mask, g), hn::IfThenElseZero(mask, b),
            hn::IfThenElseZero(mask, a)};
  }
  static HWY_INLINE Color chosen(M mask, const Color& yes, const Color& no) {
    return {hn::IfThenElse(mask, yes.r, no.r), hn::IfThenElse(mask, yes.g, no.g),
            hn::IfThenElse(mask, yes.b, no.b), hn::IfThenElse(mask, yes.a, no.a)};
  }
  /// See render::shortened().
  HWY_INLINE Color shortened(F part) const {
    const F one = hn::Set(kF, 1.0F);
    const M visible = hn::Gt(a, hn::Zero(kF));
    const M opaque = hn::Ge(a, one);
    const F through = hn::Exp(kF, part * hn::Log(kF, hn::IfThenElse(opaque, one, one - a)));
    const F shorter = hn::IfThenElse(opaque, one, one - through);
    return times(hn::IfThenElse(visible, shorter / a, one));
  }
};

/// Rays of a packet, in the volume's index space.
struct Rays {
  Vec3F start;      ///< position at which they enter the box
  Vec3F direction;  ///< of unit length
  F length;         ///< in the box and before the limit; 0 if a ray has no sample
  M enters;         ///< rays that begin outside the box
};

/// The segments in which rays are sampled; see RaySegments. Counts are whole numbers.
struct Segments {
  F step, per_step, length;
  F whole, count;
  F last;  ///< length of the last segment, if it is shorter than a step

  HWY_INLINE Segments(const Rays& rays, float step_voxels)
      : step(hn::Set(kF, step_voxels)),
        per_step(hn::Set(kF, 1.0F / step_voxels)),
        length(rays.length),
        whole(hn::Floor(length / step)),
        count(whole),
        last(hn::Max(hn::NegMulAdd(whole, step, length), hn::Zero(kF))) {
    count = count + hn::IfThenElseZero(hn::Gt(last, hn::Zero(kF)), hn::Set(kF, 1.0F));
  }
  HWY_INLINE F middle(F n) const {
    const F half = hn::Set(kF, 0.5F);
    return hn::IfThenElse(hn::Lt(n, whole), (n + half) * step, hn::NegMulAdd(half, last, length));
  }
  HWY_INLINE F joint(F n) const { return hn::IfThenElse(hn::Le(n, whole), n * step, length); }
};

#if HWY_TARGET == HWY_SCALAR
/// Reads two neighbouring floats.
class PairReader {
 public:
  explicit HWY_INLINE PairReader(I index) : index_(hn::GetLane(index)) {}
  HWY_INLINE void read(const float* base, F& first, F& second) const {
    first = hn::Set(kF, base[index_]);
    second = hn::Set(kF, base[index_ + 1]);
  }

 private:
  std::int32_t index_;
};
#else
/// Reads two neighbouring floats per lane with one 64-bit load.
class PairReader {
 public:
  /// @param index  in floats
  explicit HWY_INLINE PairReader(I index) {
    const hn::Half<TagI> half;
    const TagOffset wide;
    low_ = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::LowerHalf(half, index)));
    high_ = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::UpperHalf(half, index)));
  }
  HWY_INLINE void read(const float* base, F& first, F& second) const {
    const TagOffset wide;
    const auto* from = reinterpret_cast<const std::int64_t*>(base);
    const F low = hn::BitCast(kF, hn::GatherOffset(wide, from, low_));
    const F high = hn::BitCast(kF, hn::GatherOffset(wide, from, high_));
    first = hn::ConcatEven(kF, high, low);
    second = hn::ConcatOdd(kF, high, low);
  }

 private:
  Offset low_, high_;
};
#endif

/// Reads pairs of neighbouring codes and interpolates them: code times QuantizedValues::kWeights if both are
/// equal.
class CodePairs {
 public:
  /// @param index     in codes
  /// @param fraction  0..1, from the first code of a pair to the second
  HWY_INLINE CodePairs(I index, F fraction)
      : offset_(hn::ShiftLeft<1>(index)),
        second_(hn::NearestInt(fraction * hn::Set(kF, static_cast<float>(QuantizedValues::kWeights)))) {}

#if HWY_TARGET == HWY_SCALAR
  HWY_INLINE F read(const std::int16_t* codes) const {
    const std::int16_t* pair = codes + hn::GetLane(offset_) / 2;
    const std::int32_t second = hn::GetLane(second_);
    return hn::Set(kF, static_cast<float>(pair[0] * (QuantizedValues::kWeights - second) + pair[1] * second));
  }
#else
  HWY_INLINE F read(const std::int16_t* codes) const {
    const hn::Repartition<std::int16_t, TagI> pairs;
    const I zero = hn::Zero(kI);
    const I weights = hn::Or(hn::ShiftLeft<16>(second_), hn::Set(kI, QuantizedValues::kWeights) - second_);
    const I pair = hn::GatherOffset(kI, reinterpret_cast<const std::int32_t*>(codes), offset_);
    I unused = zero;
    return hn::ConvertTo(kF, hn::ReorderWidenMulAccumulate(kI, hn::BitCast(pairs, pair),
                                                           hn::BitCast(pairs, weights), zero, unused));
  }
#endif

 private:
  I offset_, second_;
};

/// One axis of a cell: its low corner, and the position relative to it, 0..1.
struct CellAxis {
  I low;
  F fraction;

  HWY_INLINE CellAxis(F position, int count) {
    const F last = hn::Set(kF, static_cast<float>(count - 1));
    const F held = hn::Min(hn::Max(position, hn::Zero(kF)), last);
    low = hn::Min(hn::ConvertTo(kI, held), hn::Set(kI, count > 1 ? count - 2 : 0));
    fraction = held - hn::ConvertTo(kF, low);
  }
  HWY_INLINE I nearest() const {
    return low + hn::IfThenElseZero(hn::RebindMask(kI, hn::Ge(fraction, hn::Set(kF, 0.5F))), hn::Set(kI, 1));
  }
};

HWY_INLINE F lerp(F a, F b, F fraction) {
  return hn::MulAdd(fraction, b - a, a);
}

/// Reads the volume's own values.
struct ValueReader {
  static HWY_INLINE F cell(const VolumeView& volume, long long row, long long layer, I low, F x, F y, F z) {
    const PairReader pairs(low);
    F v000, v100, v010, v110, v001, v101, v011, v111;
    pairs.read(volume.values, v000, v100);
    pairs.read(volume.values + row, v010, v110);
    pairs.read(volume.values + layer, v001, v101);
    pairs.read(volume.values + layer + row, v011, v111);
    const F below = lerp(lerp(v000, v100, x), lerp(v010, v110, x), y);
    const F above = lerp(lerp(v001, v101, x), lerp(v011, v111, x), y);
    return lerp(below, above, z);
  }
};

/// Reads the volume's codes, which must exist.
struct CodedReader {
  static HWY_INLINE F cell(const VolumeView& volume, long long row, long long layer, I low, F x, F y, F z) {
    const CodePairs pairs(low, x);
    const QuantizedValues& coded = volume.coded;
    const F below = lerp(pairs.read(coded.codes), pairs.read(coded.codes + row), y);
    const F above = lerp(pairs.read(coded.codes + layer), pairs.read(coded.codes + layer + row), y);
    return hn::MulAdd(lerp(below, above, z), hn::Set(kF, coded.step_per_weight), hn::Set(kF, coded.middle));
  }
};

/// See TrilinearSampler. @param shown  lanes whose nearest voxel is masked are removed
template <class Reader>
HWY_INLINE F sampleVolume(const VolumeView& volume, const Vec3F& position, M& shown) {
  const Dims dims = volume.dims;
  const CellAxis x(position.x, dims.x);
  const CellAxis y(position.y, dims.y);
  const CellAxis z(position.z, dims.z);
  if (volume.masked_below > 0) {
    const M low = hn::And(shown, hn::RebindMask(kF, hn::Lt(z.low, hn::Set(kI, volume.masked_below))));
    if (!hn::AllFalse(kF, low)) {
      const I column = y.nearest() * hn::Set(kI, dims.x) + x.nearest();
      const I first_valid = hn::GatherIndex(kI, volume.first_valid_k, column);
      shown = hn::AndNot(hn::RebindMask(kF, hn::Lt(z.nearest(), first_valid)), shown);
    }
  }
  const long long row = dims.y > 1 ? dims.x : 0;
  const long long layer = dims.z > 1 ? static_cast<long long>(dims.x) * dims.y : 0;
  const I low = (z.low * hn::Set(kI, dims.y) + y.low) * hn::Set(kI, dims.x) + x.low;
  return Reader::cell(volume, row, layer, low, x.fraction, y.fraction, z.fraction);
}

/// See TransferView.
HWY_INLINE F normalized(const TransferView& transfer, F value) {
  const F f = (value - hn::Set(kF, transfer.lowest)) * hn::Set(kF, transfer.scale);
  return hn::Min(hn::Max(f, hn::Zero(kF)), hn::Set(kF, 1.0F));
}
HWY_INLINE I tableIndex(const TransferView& transfer, F f) {
  return hn::ConvertTo(kI, hn::MulAdd(f, hn::Set(kF, static_cast<float>(transfer.last)), hn::Set(kF, 0.5F)));
}
HWY_INLINE Color lookUp(const Rgba* table, I index) {
  const PairReader entry(hn::ShiftLeft<2>(index));
  Color color;
  entry.read(&table->r, color.r, color.g);
  entry.read(&table->b, color.b, color.a);
  return color;
}

/// The bricks around rays; see SkipView::at().
class BrickWalk {
 public:
  HWY_INLINE BrickWalk(const RaycastTask& task, const Vec3F& direction)
      : x_(direction.x, task.volume.dims.x),
        y_(direction.y, task.volume.dims.y),
        z_(direction.z, task.volume.dims.z),
        row_(hn::Set(kI, task.skip.dims.x)),
        rows_(hn::Set(kI, task.skip.dims.y)) {}

  /// @param brick  receives the index of the brick around a position
  /// @return voxels along the ray that are certainly in the brick
  HWY_INLINE F look(const Vec3F& position, I& brick) const {
    I x, y, z;
    const F leave =
        hn::Min(hn::Min(x_.along(position.x, x), y_.along(position.y, y)), z_.along(position.z, z));
    brick = (z * rows_ + y) * row_ + x;
    return hn::Max(leave - hn::Set(kF, SkipView::kFaceMargin), hn::Zero(kF));
  }

 private:
  struct Axis {
    F last, voxels_per_unit;
    I ahead;  ///< 1 if the ray leaves a brick by its upper face

    HWY_INLINE Axis(F direction, int voxels)
        : last(hn::Set(kF, static_cast<float>(voxels - 1))),
          voxels_per_unit(hn::IfThenElse(hn::Eq(direction, hn::Zero(kF)), hn::Set(kF, -1e30F),
                                         hn::Set(kF, 1.0F) / direction)),
          ahead(hn::IfThenElseZero(hn::RebindMask(kI, hn::Gt(direction, hn::Zero(kF))), hn::Set(kI, 1))) {}

    /// @return distance to the brick's far face, not beyond it in the outer half of the border's voxels
    HWY_INLINE F along(F position, I& brick) const {
      const F held = hn::Min(hn::Max(position, hn::Zero(kF)), last);
      brick = hn::ShiftRight<SkipView::kEdgeBits>(hn::ConvertTo(kI, held));
      const F face = hn::ConvertTo(kF, hn::ShiftLeft<SkipView::kEdgeBits>(brick + ahead));
      return (face - position) * voxels_per_unit;
    }
  };

  const Axis x_, y_, z_;
  const I row_, rows_;
};

}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#endif
