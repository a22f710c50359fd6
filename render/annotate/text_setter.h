/// Lines of text set by Pango: fallback fonts, shaping, right to left. The pixels depend on the installed
/// fonts, not on the locale. Threads may share these functions.
#pragma once

#include <string>

#include "render/annotate/canvas.h"

namespace emscape::render {

/// Loads what all texts need: before the first file of work that ends with a picture.
/// @throws Error (other) where memory is short; std::system_error where Pango's threads cannot be started
void requireFonts();

/// Advance of a line (pixels). Bytes that are not UTF-8 are drawn as U+FFFD.
double lineWidth(const std::string& text, double size_px, Weight weight);

/// Fills the glyphs of a line with the source of a drawing. @param begin  left end of the baseline
void fillLine(_cairo* cairo, const std::string& text, double size_px, Weight weight, const Point2& begin);

/// Adds the outlines of a line's glyphs to the path of a drawing.
void addLineToPath(_cairo* cairo, const std::string& text, double size_px, Weight weight,
                   const Point2& begin);

}  // namespace emscape::render
