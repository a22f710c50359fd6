/// Texts of several lines, which end as withLineBreaks() says; Dear ImGui also ends lines inside of numbers.
#pragma once

#include <string>

namespace emscape::view {

/// A text that is drawable(), with line ends. @param width  of the lines (pixels)
std::string wrapped(const std::string& text, float width);
/// Draws a text of the user or of ours, as wide as the rest of the line.
void textWrapped(const std::string& text);

}  // namespace emscape::view
