/// Reading of whole files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace emscape {

/// All bytes of a regular file.
/// @throws Error (bad_input) that names the path and the cause: no such file, not a regular file, no
/// permission, more than max_bytes
std::vector<std::uint8_t> readWhole(const std::filesystem::path& path,
                                    std::uintmax_t max_bytes = UINTMAX_MAX);
/// The same bytes as a string. The encoding is not checked.
std::string readWholeText(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

/// The same, also of a pipe or a device such as /dev/stdin, up to its end.
std::string readTextOrPipe(const std::filesystem::path& path);

}  // namespace emscape
