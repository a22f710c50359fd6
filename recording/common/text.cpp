#include "recording/common/text.h"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>

#include "base/text/utf8.h"

namespace emscape::interop {
namespace {

constexpr std::size_t kLongestName = 150;

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> numberIn(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool isUtf8(std::string_view text, bool is_beginning) {
  constexpr std::size_t kLongestSequence = 4;
  while (!text.empty()) {
    const std::size_t length = utf8SequenceLength(text);
    if (length == 0) return is_beginning && text.size() < kLongestSequence;
    text.remove_prefix(length);
  }
  return true;
}

std::string declaredEncoding(std::string_view text) {
  constexpr std::string_view kEncoding = "encoding=";
  text = text.substr(0, text.find("?>"));
  const std::size_t at = text.find(kEncoding);
  if (text.find("<?xml") == std::string_view::npos || at == std::string_view::npos) return "";
  const std::size_t begin = at + kEncoding.size() + 1;
  if (begin >= text.size()) return "";
  return std::string(text.substr(begin, text.find_first_of("\"'", begin) - begin));
}

std::string utf8Of(std::string_view text, const std::string& encoding, std::string* told) {
  const std::string stated = encoding.empty() ? "LATIN1" : encoding;
  iconv_t converter = iconv_open("UTF-8", stated.c_str());
  const bool is_known = converter != reinterpret_cast<iconv_t>(-1);
  if (!is_known) converter = iconv_open("UTF-8", "LATIN1");
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::string(text);
  std::string converted;
  std::string input(text);
  char* from = input.data();
  std::size_t left = input.size(), foreign = 0;
  std::array<char, 4096> part{};
  while (left > 0) {
    char* to = part.data();
    std::size_t room = part.size();
    const bool failed = iconv(converter, &from, &left, &to, &room) == static_cast<std::size_t>(-1);
    converted.append(part.data(), part.size() - room);
    if (!failed || errno == E2BIG) continue;
    const auto byte = static_cast<unsigned char>(*from);  // without a meaning, or of a character that is cut
    if (byte >= 0x80) converted += static_cast<char>(0xC0 | byte >> 6);
    converted += static_cast<char>(byte < 0x80 ? byte : 0x80 | (byte & 0x3F));
    ++from;
    --left;
    ++foreign;
  }
  iconv_close(converter);
  if (told == nullptr) return converted;
  if (encoding.empty()) {
    *told =
        "not in UTF-8: letters of names are taken as Latin-1; 'iconv -f ENCODING -t UTF-8 OLD > NEW' "
        "converts a text in another encoding, such as WINDOWS-1251";
  } else if (!is_known || foreign > 0) {
    *told = fmt::format(
        "states the encoding {}, {}: letters of names are taken as Latin-1; its first line should state the "
        "encoding that it has, such as encoding=\"windows-1251\"",
        printableText(encoding),
        is_known ? fmt::format("in which {} of its bytes have no meaning", foreign) : "which is not known");
  }
  return converted;
}

std::string printableText(std::string_view text) {
  std::string value(text);
  for (char& c : value) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  }
  value = xmlCharacters(value);
  if (value.size() > kLongestName) value = xmlCharacters(value.substr(0, kLongestName));
  return value;
}

std::vector<std::string> wordsOf(std::string_view line, const std::vector<std::string_view>& comments) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while (at < line.size()) {
    if (line[at] == ' ' || line[at] == '\t' || line[at] == '\r') {
      ++at;
      continue;
    }
    const std::string_view rest = line.substr(at);
    const bool is_comment = std::any_of(comments.begin(), comments.end(), [&](std::string_view begin) {
      return rest.substr(0, begin.size()) == begin;
    });
    if (is_comment) break;
    if (rest.front() == '"') {
      const std::size_t end = std::min(rest.find('"', 1), rest.size());
      words.emplace_back(rest.substr(1, end - 1));
      at += std::min(end + 1, rest.size());
    } else {
      const std::size_t end = std::min(rest.find_first_of(" \t\r"), rest.size());
      words.emplace_back(rest.substr(0, end));
      at += end;
    }
  }
  return words;
}

}  // namespace emscape::interop
