/// Legends of pictures whose values go beyond the colours.
#pragma once

#include "render/annotate/overlay_parts.h"

namespace emscape::render {

/// Whether values are beyond the ends of a colour bar, which have the colours there.
struct LegendEnds {
  bool has_lower = false, has_higher = false;
};

/// drawLegend() with "≤" and "≥" at such ends.
void drawLegend(Canvas& canvas, const Style& style, const Legend& legend, LegendEnds ends);

}  // namespace emscape::render
