/// Symbols with a side: frames and icons of MIL-STD-2525 and APP-6.
#pragma once

#include <string>

#include "emscape/render/annotate/overlay.h"
#include "render/annotate/canvas.h"
#include "render/annotate/side_color.h"

namespace emscape::render {

/// Frame in the colour of a side, which also has its shape: friend a rectangle, hostile a diamond, neutral a
/// square, unknown a quatrefoil. In it the icon of a SIDC.
/// @param sidc    20 or more digits; empty: the frame of a land unit without an icon. An entity without a
/// drawing has
///                that of its entity type or entity; a set without drawings has only the frame
/// @param radius  half the side of the square around the frame (pixels)
/// @param is_active  false: paler
void drawMilitarySymbol(Canvas& canvas, Affiliation side, const std::string& sidc, bool is_active,
                        const Point2& at, double radius, double alpha = 1);

}  // namespace emscape::render
