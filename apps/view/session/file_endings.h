/// Endings of the files that the window writes.
#pragma once

#include <string>
#include <vector>

namespace emscape::view {

inline const std::vector<std::string> kPictureEndings{".png"};
inline const std::vector<std::string> kScenarioEndings{".yaml", ".yml", ".json"};
/// Of views and transfer functions.
inline const std::vector<std::string> kJsonEndings{".json"};

/// @param file  empty: a default name will be used
/// @throws Error (usage) that names the file and the endings if it has none of them, in upper or lower case
void requireEnding(const std::string& file, const std::vector<std::string>& endings);

}  // namespace emscape::view
