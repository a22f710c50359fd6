/// Files and folders that a user names as inputs: a cause of the system is bad input, not a failure of the
/// program.
#pragma once

#include <filesystem>
#include <vector>

namespace emscape {

/// Whether there is a file or folder of that name, links followed.
/// @throws Error (bad_input) that names the path and the cause if that cannot be told: a name that is too
/// long, a link to itself, a folder that may not be entered
bool inputExists(const std::filesystem::path& path);

/// The entries of a folder, in the order of the file system.
/// @throws Error (bad_input) that names the folder and the cause
std::vector<std::filesystem::directory_entry> entriesOf(const std::filesystem::path& folder);

}  // namespace emscape
