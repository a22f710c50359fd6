/// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace emscape {

/// Text with the characters that XML reserves escaped, for elements and attributes. Characters that XML does
/// not allow become U+FFFD.
std::string escapedXml(std::string_view text);

}  // namespace emscape
