#include "base/files/file_digest.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "base/large_array.h"
#include "emscape/base/error.h"

namespace emscape {

namespace {

/// Writes the part of a patch that falls into a block.
void apply(const FilePatch& patch, char* block, std::uint64_t begin, std::uint64_t end) {
  const std::uint64_t from = std::max(begin, patch.offset);
  const std::uint64_t to = std::min(end, patch.offset + patch.bytes.size());
  if (from < to) patch.bytes.copy(block + (from - begin), to - from, from - patch.offset);
}

}  // namespace

int addToDigest(const Descriptor& file, FileDigest& digest, const std::vector<FilePatch>& patches) {
  std::vector<char> block(1 << 20);
  ByteCheckpoints checkpoints;
  const off_t begin = patches.empty() ? 0 : ::lseek(file.number(), 0, SEEK_CUR);
  if (begin < 0) return errno;
  auto at = static_cast<std::uint64_t>(begin);
  for (;;) {
    const ssize_t read = ::read(file.number(), block.data(), block.size());
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return errno;
    if (read == 0) return 0;
    const auto bytes = static_cast<std::size_t>(read);
    for (const FilePatch& patch : patches) apply(patch, block.data(), at, at + bytes);
    at += bytes;
    addToDigest({block.data(), bytes}, digest);
    checkpoints.add(bytes);
  }
}

void addToDigest(std::string_view bytes, FileDigest& digest) {
  const auto* const data = reinterpret_cast<const Bytef*>(bytes.data());
  digest.crc32 = static_cast<std::uint32_t>(::crc32_z(digest.crc32, data, bytes.size()));
  digest.bytes += bytes.size();
}

FileDigest digestOf(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  FileDigest digest;
  const int cause = file.isOpen() ? addToDigest(file, digest) : errno;
  if (cause != 0) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(cause));
  return digest;
}

}  // namespace emscape
