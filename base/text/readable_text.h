/// Messages that quote contents of a file.
#pragma once

#include <string>

namespace emscape {

/// A readable message: control characters, except line ends, become '?', and the middle of very long lines is
/// left out.
std::string readableText(std::string message);

}  // namespace emscape
