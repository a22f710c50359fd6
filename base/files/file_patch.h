/// Changes of bytes within existing files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace emscape {

/// Bytes that overwrite as many bytes of a file.
struct FilePatch {
  std::uint64_t offset = 0;
  std::string bytes;
};

/// Overwrites parts of a file in place; they are on the disk at return. Not atomic: after a crash of the
/// machine some of the patches may be unwritten.
/// @throws Error (other); links are refused
void patchFile(const std::filesystem::path& path, const std::vector<FilePatch>& patches);

}  // namespace emscape
