#include "base/text/utf8.h"

namespace emscape {
namespace {

bool isControl(char32_t code_point) {
  return code_point < 0x20 || (code_point >= 0x7F && code_point <= 0x9F);
}

bool isNoncharacter(char32_t code_point) {
  return (code_point >= 0xFDD0 && code_point <= 0xFDEF) || (code_point & 0xFFFE) == 0xFFFE;
}

}  // namespace

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

char32_t codePointOf(std::string_view sequence) {
  constexpr unsigned kFirstMasks[] = {0x7F, 0x1F, 0x0F, 0x07};
  char32_t code_point = static_cast<unsigned char>(sequence[0]) & kFirstMasks[sequence.size() - 1];
  for (const char c : sequence.substr(1))
    code_point = (code_point << 6) | (static_cast<unsigned char>(c) & 0x3F);
  return code_point;
}

std::optional<char32_t> firstUnprintable(std::string_view text) {
  for (std::size_t i = 0, length = 1; i < text.size(); i += length) {
    length = utf8SequenceLength(text.substr(i));
    if (length == 0) {
      length = 1;
      continue;
    }
    const char32_t code_point = codePointOf(text.substr(i, length));
    if (isControl(code_point) || isNoncharacter(code_point)) return code_point;
  }
  return std::nullopt;
}

std::string xmlCharacters(std::string_view text) {
  std::string result;
  for (std::size_t i = 0, length = 1; i < text.size(); i += length) {
    length = utf8SequenceLength(text.substr(i));
    const char32_t code_point = length == 0 ? 0 : codePointOf(text.substr(i, length));
    const bool is_allowed = code_point >= 0x20
                                ? code_point != 0xFFFE && code_point != 0xFFFF
                                : code_point == '\t' || code_point == '\n' || code_point == '\r';
    if (length == 0) length = 1;
    if (is_allowed) {
      result += text.substr(i, length);
    } else {
      result += "\xEF\xBF\xBD";
    }
  }
  return result;
}

}  // namespace emscape
