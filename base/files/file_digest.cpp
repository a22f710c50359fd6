#include "base/files/file_digest.h"

#include <zlib.h>

#include <cerrno>
#include <fstream>
#include <vector>

#include "base/files/descriptor.h"
#include "base/large_array.h"
#include "emscape/base/error.h"

namespace emscape {

FileDigest digestOf(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(errno));
  FileDigest digest;
  uLong crc = ::crc32(0, nullptr, 0);
  std::vector<char> block(1 << 20);
  ByteCheckpoints checkpoints;
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto bytes = static_cast<std::size_t>(stream.gcount());
    crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(block.data()), bytes);
    digest.bytes += bytes;
    checkpoints.add(bytes);
  }
  if (!stream.eof()) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(errno));
  digest.crc32 = static_cast<std::uint32_t>(crc);
  return digest;
}

}  // namespace emscape
