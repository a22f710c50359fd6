#include "render/picture/png_comment.h"

#include <zlib.h>

#include <cstdint>

namespace emscape::render {

std::string withPngComment(std::string png, const std::string& comment) {
  if (comment.empty()) return png;
  const std::string content = std::string("iTXtComment") + std::string(5, '\0') + comment;
  const auto bytesOf = [](std::uint32_t number) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 255U);
    return bytes;
  };
  const uLong crc =
      ::crc32_z(::crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(content.data()), content.size());
  constexpr std::size_t kEndOfHeader = 33;  // signature and IHDR
  png.insert(kEndOfHeader, bytesOf(static_cast<std::uint32_t>(content.size() - 4)) + content +
                               bytesOf(static_cast<std::uint32_t>(crc)));
  return png;
}

}  // namespace emscape::render
