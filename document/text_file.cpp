#include "document/text_file.h"

#include <fmt/format.h>

#include "base/text/utf8.h"

namespace emscape::document {

namespace {

bool isForbiddenControl(unsigned char c) {
  return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

}  // namespace

std::string checkedUtf8(const std::string& file, std::string bytes) {
  if (bytes.compare(0, 3, "\xEF\xBB\xBF") == 0) bytes.erase(0, 3);
  int line = 1, column = 1;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = utf8SequenceLength(std::string_view(bytes).substr(i));
    const unsigned char byte = static_cast<unsigned char>(bytes[i]);
    if (length == 0) {
      throw Error(ErrorCode::bad_input, {file, line, column},
                  fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8", byte));
    }
    if (isForbiddenControl(byte)) {
      throw Error(ErrorCode::bad_input, {file, line, column},
                  fmt::format("control character 0x{:02x}", byte));
    }
    i += length;
    ++column;
    if (byte == '\n') {
      ++line;
      column = 1;
    }
  }
  return bytes;
}

std::size_t characterCount(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return count;
}

void ContentHash::add(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 1099511628211ull;
  for (const char c : bytes) state_ = (state_ ^ static_cast<unsigned char>(c)) * kPrime;
}

std::string ContentHash::hex() const {
  return fmt::format("{:016x}", state_);
}

}  // namespace emscape::document
