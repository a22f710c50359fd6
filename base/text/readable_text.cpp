#include "base/text/readable_text.h"

#include <algorithm>
#include <string_view>

namespace emscape {
namespace {

constexpr std::size_t kLongestLine = 800;
constexpr std::string_view kLeftOut = " ... ";
constexpr std::size_t kLineBegin = 500, kLineEnd = 200;  // of a longer one

/// The first byte of a character of UTF-8 at or before `at`; `at` itself in other bytes.
std::size_t characterBegin(const std::string& text, std::size_t at) {
  constexpr std::size_t kMaxFollowing = 3;
  for (std::size_t back = 0; back <= std::min(kMaxFollowing, at); ++back) {
    if ((static_cast<unsigned char>(text[at - back]) & 0xC0) != 0x80) return at - back;
  }
  return at;
}

}  // namespace

std::string readableText(std::string message) {
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7F; },
      '?');
  std::string text;
  for (std::size_t begin = 0; begin < message.size();) {
    const std::size_t end = std::min(message.find('\n', begin), message.size());
    if (end - begin > kLongestLine) {
      const std::size_t from = characterBegin(message, begin + kLineBegin);
      text.append(message, begin, from - begin);
      text += kLeftOut;
      begin = characterBegin(message, end - kLineEnd);
    }
    text.append(message, begin, end + 1 - begin);  // with the line's end
    begin = end + 1;
  }
  return text;
}

}  // namespace emscape
