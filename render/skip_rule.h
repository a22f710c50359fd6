/// What SkipView says of a brick, from the range of its values: single source for host and device.
#pragma once

#include "base/host_device.h"
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

}  // namespace emscape::render
