/// Names in file names.
#pragma once

#include <string>
#include <vector>

namespace emscape::playback {

/// A scenario's or channel's name as a part of a file's name: letters, digits, '_' and '-'; anything else
/// becomes '_'. Names of more than 80 bytes are shortened and end in their checksum.
std::string fileNameOf(const std::string& name);

/// The same for several names, with distinct results: later ones get "-2", "-3" and so on.
std::vector<std::string> distinctFileNames(const std::vector<std::string>& names);

}  // namespace emscape::playback
