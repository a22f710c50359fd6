/// Names as parts of file names.
#pragma once

#include <string>

namespace emscape::app {

/// A scenario's or channel's name as a part of a file's name: letters, digits, '_' and '-'; anything else
/// becomes '_'.
std::string fileNameOf(const std::string& name);

}  // namespace emscape::app
