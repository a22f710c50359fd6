/// Size and checksum of files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/descriptor.h"

namespace emscape {

/// Size and checksum of a file's content.
struct FileDigest {
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;

  bool operator==(const FileDigest& other) const { return bytes == other.bytes && crc32 == other.crc32; }
  bool operator!=(const FileDigest& other) const { return !(*this == other); }
};
/// Bytes that overwrite as many bytes of a file.
struct FilePatch {
  std::uint64_t offset = 0;
  std::string bytes;
};

/// Adds what follows the present position of an open file, as it will be with the patches.
/// @return errno, 0 if all went well
int addToDigest(const Descriptor& file, FileDigest& digest, const std::vector<FilePatch>& patches = {});
void addToDigest(std::string_view bytes, FileDigest& digest);
/// @throws Error (bad_input) that names the path and the cause
FileDigest digestOf(const std::filesystem::path& path);

}  // namespace emscape
