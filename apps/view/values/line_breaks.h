/// Line breaks of texts in panels.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace emscape::view {

/// Breaks a text at its blanks into lines of a width. A number stays in one line with what follows it: its
/// unit, or the thing that it counts. A word that is wider than a line is broken after a '/', else anywhere.
/// @param widthOf  of a text without line ends; that of a text is the sum of those of its parts
std::string withLineBreaks(const std::string& text, float width,
                           const std::function<float(std::string_view)>& widthOf);

}  // namespace emscape::view
