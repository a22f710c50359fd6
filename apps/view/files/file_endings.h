/// Endings of the files that the window writes.
#pragma once

#include <string>

namespace emscape::view {

// An empty name is allowed: a default one will be used. They throw Error (usage) that names the file and the
// endings if it has none of them, in upper or lower case.

void requirePictureEnding(const std::string& file);
void requireScenarioEnding(const std::string& file);
/// Of views and transfer functions.
void requireJsonEnding(const std::string& file);

}  // namespace emscape::view
