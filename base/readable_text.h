/// Messages that quote what was found in a file.
#pragma once

#include <string>

namespace emscape {

/// A message in clear lines: control characters, except line ends, are '?', and the middle of very long lines
/// is left out.
std::string readableText(std::string message);

}  // namespace emscape
