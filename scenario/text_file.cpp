#include "scenario/text_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace emscape::scenario {

namespace {

/// Bytes of the UTF-8 sequence that begins at `text[0]`; 0 if none begins there (RFC 3629: no overlong forms,
/// no surrogates).
std::size_t utf8SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto continues = [&](std::size_t i, unsigned lowest = 0x80, unsigned highest = 0xBF) {
    return i < text.size() && byte(i) >= lowest && byte(i) <= highest;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    return continues(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && continues(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    return continues(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && continues(2) &&
                   continues(3)
               ? 4
               : 0;
  }
  return 0;
}

bool isForbiddenControl(unsigned char c) {
  return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

}  // namespace

std::string readWholeFile(const std::string& file, std::size_t limit_bytes) {
  const SourceLocation place{file, 0, 0};
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (!std::filesystem::exists(status)) throw Error(ErrorCode::bad_input, place, "there is no such file");
  if (!std::filesystem::is_regular_file(status)) throw Error(ErrorCode::bad_input, place, "is not a file");
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (size > limit_bytes && !failure) {
    throw Error(ErrorCode::bad_input, place,
                fmt::format("is {} bytes large, more than the allowed {}", size, limit_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(failure ? 0 : static_cast<std::size_t>(size), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (failure || !stream) throw Error(ErrorCode::bad_input, place, "cannot be read");
  return bytes;
}

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

}  // namespace emscape::scenario
