/// SkipView's entries of a brick, from the range of its values: single source for host and device.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/render/render_settings.h"
#include "render/compositing.h"
#include "render/volume_view.h"
#include "volume/bricks.h"

namespace emscape::render {

/// One brick's entries of SkipView.
struct BrickLevel {
  float highest = -1;
  float level = -1;
};

/// Plain data; see TransferTable::skipRule().
struct SkipRule {
  TransferView table;
  const int* visible_before = nullptr;  ///< how many entries of the table before each have an opacity
  CompositingMode mode = CompositingMode::dvr;
  float iso_value = 0;

  EMSCAPE_HD BrickLevel of(const volume::ValueRange& range) const {
    if (range.empty()) return {};  // nothing in it shows, not even 0
    // Interpolation may round a little beyond its operands.
    const float rounding = range.max > range.min ? (range.max - range.min) * 1e-6F : 0.0F;
    const float highest = table.normalized(range.max + rounding);
    bool needed = false;
    if (mode == CompositingMode::iso) {
      needed = range.min - rounding < iso_value && range.max + rounding >= iso_value;
    } else if (mode != CompositingMode::mip) {
      needed = anyVisible(range);
    }
    return {highest, needed ? SkipView::kNever : highest};
  }

 private:
  /// Whether any value of a range has an opacity.
  EMSCAPE_HD bool anyVisible(const volume::ValueRange& range) const {
    // One entry more on each side: interpolation may round a little beyond its operands.
    const int first = table.index(table.normalized(range.min)) - 1;
    const int last = table.index(table.normalized(range.max)) + 1;
    return visible_before[(last < table.last ? last : table.last) + 1] !=
           visible_before[first > 0 ? first : 0];
  }
};

/// Whether testing for bricks to skip pays on a GPU. It costs a part of the frame if anything is skipped or
/// not: on an H100, while they were always looked for, about 0.14 of a full frame of DVR, 0.24 of one with a
/// quarter of the rays, 0.5 of one of MIDA. Of the samples in bricks that can be skipped two thirds are
/// saved, as rays go in groups that skip together. MIDA moreover skips only what is below its maximum so far.
/// Maximum projection and isosurfaces skip most of any volume.
/// @param skippable_share  of the bricks, 0..1: those of a level below SkipView::kNever
inline bool skippingPays(CompositingMode mode, double skippable_share) {
  constexpr double kMinShareDvr = 0.3;
  constexpr double kMinShareMida = 0.8;
  switch (mode) {
    case CompositingMode::dvr:
      return skippable_share >= kMinShareDvr;
    case CompositingMode::mida:
      return skippable_share >= kMinShareMida;
    case CompositingMode::mip:
    case CompositingMode::iso:
      break;
  }
  return true;
}

}  // namespace emscape::render
