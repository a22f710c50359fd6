/// SkipView's entries of a brick, from the range of its values: single source for host and device.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/render/scene/render_settings.h"
#include "render/cast/compositing.h"
#include "render/cast/volume_view.h"
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
  const int* visible_before = nullptr;  ///< number of entries of the table before each with an opacity
  CompositingMode mode = CompositingMode::dvr;
  float iso_value = 0;

  EMSCAPE_HD BrickLevel of(const volume::ValueRange& range) const {
    if (range.empty()) return {};  // nothing in it is visible, not even 0
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
  /// True if any value of a range has an opacity.
  EMSCAPE_HD bool anyVisible(const volume::ValueRange& range) const {
    // One entry more on each side: interpolation may round a little beyond its operands.
    const int first = table.index(table.normalized(range.min)) - 1;
    const int last = table.index(table.normalized(range.max)) + 1;
    return visible_before[(last < table.last ? last : table.last) + 1] !=
           visible_before[first > 0 ? first : 0];
  }
};

/// True if testing for bricks to skip is worthwhile on a GPU. The test has a cost even if nothing is skipped:
/// on an H100, when it was always made, about 0.14 of a full frame of DVR, 0.24 of one with a quarter of the
/// rays, 0.5 of one of MIDA. Two thirds of the samples in bricks that can be skipped are saved, because rays
/// skip in groups. MIDA also skips only bricks below its present maximum. Maximum projection and isosurfaces
/// skip most of any volume.
/// @param skippable_share  fraction 0..1 of the bricks with a level below SkipView::kNever
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
