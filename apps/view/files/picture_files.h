/// Names of new screenshots.
#pragma once

#include <set>
#include <string>

namespace emscape::view {

/// The first emscape-NNNN.png that does not exist and was not given out before, in the user's folder of
/// pictures (XDG_PICTURES_DIR, else
/// ~/Pictures); if there is none, in the folder of the input, and if that cannot be written, in the working
/// folder.
/// @param input  may be empty
/// @param given  names given out before, which may not be written yet; the result is added
std::string newPictureFile(const std::string& input, std::set<std::string>& given);

}  // namespace emscape::view
