/// Combination of the samples of a ray into a pixel: one small functor per mode, plain data for host and
/// device.
#pragma once

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "render/cast/rgba.h"
#include "render/cast/volume_view.h"

namespace emscape::render {

/// Opacity (of one reference step) after `steps` of them: 1 - (1 - a)^steps. @param opacity 0..1, steps > 0
EMSCAPE_HD inline float opacityOver(float opacity, float steps) {
  return opacity >= 1.0F ? 1.0F : 1.0F - power(1.0F - opacity, steps);
}
/// A sample of one step, shortened to a part of the step. @param sample premultiplied; part 0..1
EMSCAPE_HD inline Rgba shortened(const Rgba& sample, float part) {
  return sample.a > 0.0F ? sample * (opacityOver(sample.a, part) / sample.a) : sample;
}

/// 0..1; NaN is 0.
EMSCAPE_HD inline float saturate(float value) {
#if defined(__CUDA_ARCH__)
  return __saturatef(value);  // part of the instruction before
#else
  return value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
#endif
}

/// A transfer function as a table over normalised values f in 0..1. Plain data.
struct TransferView {
  const Rgba* samples = nullptr;  ///< premultiplied, opacity corrected for the sampling step
  const Rgba* projected =
      nullptr;       ///< premultiplied, opacity relative to the function's largest: for maximum projection
  int last = 0;      ///< index of the last entry
  float lowest = 0;  ///< the value at f = 0
  float scale = 0;   ///< f per unit of the value

  /// f of a value, clamped to 0..1; NaN is 0.
  EMSCAPE_HD float normalized(float value) const { return saturate((value - lowest) * scale); }
  EMSCAPE_HD int index(float f) const {
    return static_cast<int>(multiplyAdd(f, static_cast<float>(last), 0.5F));
  }
};

/// Interface of every compositor. Samples are added front to back; `f` is normalised, `sample` premultiplied
/// and corrected for its length.
///   kNeedsColor           false: add() does not look at `sample`
///   canSkip(level)        whether the samples of a brick change nothing; see SkipView::levels
///   ignores(f, sample)    whether a sample changes nothing. It is then not added, nor is done() asked: so a
///                         ray ends at the same sample whether or not bricks are skipped
///   add(f, sample)        takes one sample
///   done(ahead, next)     whether nothing from sample `next` on can matter (any more than early termination
///                         allows); ahead.exceeds(next, f): whether any sample from there on can exceed f
///   kEndsItself           add() changes nothing once done() is true: done() need not be asked after each
///   kParts                parts of a ray that can be composited apart and joined; 1: it cannot be divided
///   behind(), join(part)  a compositor for a part behind what is composited so far; adds that part
///   nearlyDone()          true where done() is, and where rounding might make it so: of parts that were
///                         composited without knowing what is in front of them
///   sample result(transfer)      the ray's colour, premultiplied
/// `volume_highest_f` is the largest f that any sample can have.

/// Opacity beyond which a ray ends; rays that are cast exactly go on to the end.
constexpr float kOpaqueEnough = 0.99F;
constexpr float kNeverOpaqueEnough = 2.0F;

constexpr int kMaxRayParts = 8;

/// The parts of a ray, joined to two halves and these to the ray: every caster adds them up in this order, so
/// that a pixel is the same to the last bit.
template <class Compositor>
class JoinedParts {
 public:
  EMSCAPE_HD explicit JoinedParts(const Compositor& before) : before_(before), half_(before.behind()) {}

  /// The compositor of the next part.
  EMSCAPE_HD Compositor behind() const { return half_.behind(); }
  /// @param count  of parts that were joined before; of one half
  EMSCAPE_HD void join(const Compositor& parts, int count = 1) {
    half_.join(parts);
    count_ += count;
    if (count_ == Compositor::kParts / 2) beginHalf();
  }
  EMSCAPE_HD bool nearlyDone() const { return half_.nearlyDone(); }
  /// What is composited so far.
  EMSCAPE_HD Compositor whole() const {
    Compositor ray = before_;
    ray.join(half_);
    return ray;
  }

 private:
  EMSCAPE_HD void beginHalf() {
    before_ = whole();
    half_ = before_.behind();
  }

  Compositor before_, half_;
  int count_ = 0;
};

/// Direct volume rendering: emission and absorption.
struct DvrCompositor {
  static constexpr bool kNeedsColor = true;
  static constexpr bool kEndsItself = true;
  static constexpr int kParts = kMaxRayParts;
  float opaque_enough = kOpaqueEnough;
  float opacity_before = 0;  ///< of the parts before this one
  Rgba sum;

  EMSCAPE_HD DvrCompositor(float opaque, float /*gamma*/, float /*volume_highest_f*/)
      : opaque_enough(opaque) {}
  EMSCAPE_HD void add(float f, const Rgba& sample) { addIf(true, f, sample); }
  EMSCAPE_HD void addIf(bool shows, float /*f*/, const Rgba& sample) {
    sum = addScaled(sample, shows && !isDone() ? 1.0F - sum.a : 0.0F, sum);
  }
  EMSCAPE_HD bool canSkip(float level) const { return level < SkipView::kNever; }
  EMSCAPE_HD bool ignores(float /*f*/, const Rgba& sample) const { return !(sample.a > 0.0F); }
  template <class Ahead>
  EMSCAPE_HD bool done(Ahead& /*ahead*/, int /*next*/) const {
    return isDone();
  }
  EMSCAPE_HD DvrCompositor behind() const {
    DvrCompositor part(opaque_enough, 0, 0);
    part.opacity_before = opacity();
    return part;
  }
  EMSCAPE_HD void join(const DvrCompositor& part) { sum = over(sum, part.sum); }
  EMSCAPE_HD bool nearlyDone() const { return opacity() > opaque_enough - 1e-5F; }
  EMSCAPE_HD Rgba result(const TransferView& /*transfer*/) const { return sum; }

 private:
  EMSCAPE_HD float opacity() const { return multiplyAdd(sum.a, 1.0F - opacity_before, opacity_before); }
  EMSCAPE_HD bool isDone() const { return opacity() > opaque_enough; }
};

/// Maximum intensity projection: the colour of the largest value, its opacity relative to the function's
/// largest.
struct MipCompositor {
  static constexpr bool kNeedsColor = false;
  static constexpr bool kEndsItself = true;
  static constexpr int kParts = kMaxRayParts;
  float volume_highest = 1;
  float highest = -1;

  EMSCAPE_HD MipCompositor(float /*opaque*/, float /*gamma*/, float volume_highest_f)
      : volume_highest(volume_highest_f) {}
  EMSCAPE_HD void add(float f, const Rgba& sample) { addIf(true, f, sample); }
  EMSCAPE_HD void addIf(bool shows, float f, const Rgba& /*sample*/) {
    highest = shows && f > highest ? f : highest;
  }
  EMSCAPE_HD bool canSkip(float level) const { return level <= highest; }
  EMSCAPE_HD bool ignores(float f, const Rgba& /*sample*/) const { return f <= highest; }
  template <class Ahead>
  EMSCAPE_HD bool done(Ahead& /*ahead*/, int /*next*/) const {
    return highest >= volume_highest;
  }
  EMSCAPE_HD MipCompositor behind() const { return *this; }
  EMSCAPE_HD void join(const MipCompositor& part) { addIf(true, part.highest, {}); }
  EMSCAPE_HD bool nearlyDone() const { return highest >= volume_highest; }
  EMSCAPE_HD Rgba result(const TransferView& transfer) const {
    return highest >= 0.0F ? transfer.projected[transfer.index(highest)] : Rgba{};
  }
};

/// Maximum intensity difference accumulation (Bruckner and Groeller 2009): a new maximum fades what is
/// in front of it. gamma = -1 is DVR, 0 is MIDA; above 0 the picture blends towards MIP.
struct MidaCompositor {
  static constexpr bool kNeedsColor = true;
  static constexpr bool kEndsItself = false;  // what is ahead decides
  static constexpr int kParts = 1;            // a later maximum fades what is in front of it
  float gamma = 0;
  float opaque_enough = kOpaqueEnough;
  MipCompositor mip;
  Rgba sum;

  EMSCAPE_HD MidaCompositor(float opaque, float gamma_value, float volume_highest_f)
      : gamma(gamma_value), opaque_enough(opaque), mip(opaque, gamma_value, volume_highest_f) {}
  EMSCAPE_HD void add(float f, const Rgba& sample) {
    const float before = mip.highest > 0.0F ? mip.highest : 0.0F;
    const float delta = f > before ? f - before : 0.0F;
    mip.add(f, sample);
    const float beta = multiplyAdd(-delta, 1.0F + (gamma < 0.0F ? gamma : 0.0F), 1.0F);
    const float through = multiplyAdd(-beta, sum.a, 1.0F);
    sum = addScaled(sample, through, sum * beta);
  }
  EMSCAPE_HD bool canSkip(float level) const { return mip.canSkip(level); }
  EMSCAPE_HD bool ignores(float f, const Rgba& sample) const {
    return !(sample.a > 0.0F) && mip.ignores(f, sample);
  }
  template <class Ahead>
  EMSCAPE_HD bool done(Ahead& ahead, int next) const {
    return sum.a > opaque_enough && !ahead.exceeds(next, mip.highest);
  }
  EMSCAPE_HD MidaCompositor behind() const { return *this; }
  EMSCAPE_HD void join(const MidaCompositor& part) { *this = part; }
  EMSCAPE_HD Rgba result(const TransferView& transfer) const {
    return gamma <= 0.0F ? sum : sum * (1.0F - gamma) + mip.result(transfer) * gamma;
  }
};

}  // namespace emscape::render
