/// Names of new screenshots.
#pragma once

#include <string>

namespace emscape::view {

/// The first emscape-NNNN.png that does not exist, in the user's folder of pictures (XDG_PICTURES_DIR, else
/// ~/Pictures); if there is none, in the folder of the input, and if that cannot be written, in the working
/// folder.
/// @param input  may be empty
std::string newPictureFile(const std::string& input);

}  // namespace emscape::view
