/// Names of the files of a series.
#pragma once

#include <string>

namespace emscape::app {

/// A scenario's or channel's name as a part of a file's name: letters, digits, '_' and '-'; anything else
/// becomes '_'.
std::string fileNameOf(const std::string& name);

/// NAME_0001. @param number counts from 1
std::string numberedName(const std::string& name, int number);

}  // namespace emscape::app
