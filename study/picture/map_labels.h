/// Places for the names of a map's symbols.
#pragma once

#include <optional>
#include <vector>

#include "render/annotate/canvas.h"

namespace emscape::study {

/// Finds a place for each label near its symbol: beside, above or below it, then further away. No label
/// overlaps a symbol or another label, and all are within the bounds; a label without such a place has none.
/// @param at       the symbols' centres  @param radius  of the symbols
/// @param extents  width and height of each label
std::vector<std::optional<render::Rect>> placeLabels(const std::vector<render::Point2>& at, double radius,
                                                     const std::vector<render::Rect>& extents,
                                                     const render::Rect& bounds);

}  // namespace emscape::study
