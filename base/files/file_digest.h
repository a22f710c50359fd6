/// Size and checksum of files.
#pragma once

#include <cstdint>
#include <filesystem>

namespace emscape {

/// Size and checksum of a file's content.
struct FileDigest {
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;

  bool operator==(const FileDigest& other) const { return bytes == other.bytes && crc32 == other.crc32; }
  bool operator!=(const FileDigest& other) const { return !(*this == other); }
};
/// @throws Error (bad_input) that names the path and the cause
FileDigest digestOf(const std::filesystem::path& path);

}  // namespace emscape
