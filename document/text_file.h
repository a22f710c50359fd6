/// Text files: UTF-8 check and checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "emscape/base/error.h"

namespace emscape::document {

/// Removes a byte order mark and checks that the rest is UTF-8 text without control characters.
/// @param expected  content of the file, for the error about one that holds a picture, a volume or an archive
/// @throws Error (bad_input) with the location of the first byte that is not; naming the content of a file of
/// a known other format
std::string checkedUtf8(const std::string& file, std::string bytes, const std::string& expected = "text");

/// Characters (code points) of UTF-8 text.
std::size_t characterCount(std::string_view text);

/// FNV-1a, 64 bits, over all added data: detects changed inputs; no protection against forgery.
class ContentHash {
 public:
  void add(std::string_view bytes);
  /// 16 hexadecimal digits.
  std::string hex() const;

 private:
  std::uint64_t state_ = 14695981039346656037ull;
};

}  // namespace emscape::document
