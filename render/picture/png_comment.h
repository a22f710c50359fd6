/// Comments in PNG files.
#pragma once

#include <string>

namespace emscape::render {

/// The bytes of a PNG file with a comment, as text in UTF-8 (PNG, 11.3.3.4); an empty one changes nothing.
std::string withPngComment(std::string png, const std::string& comment);

}  // namespace emscape::render
