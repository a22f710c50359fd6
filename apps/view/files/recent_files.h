/// The most recently opened inputs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace emscape::view {

inline constexpr std::size_t kMaxRecentFiles = 10;

/// $XDG_STATE_HOME/emscape/recent. @throws Error (other) as playback::stateFolder()
std::filesystem::path recentFilesFile();
/// Absolute paths, the newest first; empty if nothing was opened yet or the file cannot be read.
std::vector<std::string> readRecentFiles();
/// Adds an input at the front; the file is written atomically; a warning tells if it cannot be written.
/// @return all inputs
std::vector<std::string> addRecentFile(const std::string& input);

}  // namespace emscape::view
