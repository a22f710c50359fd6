#include "scenario/antenna/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files/file_reading.h"
#include "document/text_file.h"

namespace emscape::scenario {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;
constexpr std::string_view kBlanks = " \t";

/// True for bytes outside ASCII and control characters, except line ends, tabs, and zeros, which mark binary
/// files.
bool isForeign(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x7F || (byte < 0x20 && c != '\0' && c != '\t' && c != '\n' && c != '\r');
}

}  // namespace

TextField restOf(const TextField& field, std::size_t offset) {
  const std::size_t first = std::min(field.text.find_first_not_of(kBlanks, offset), field.text.size());
  const std::size_t end = field.text.find_last_not_of(kBlanks) + 1;  // npos + 1 is 0
  return {field.text.substr(first, end > first ? end - first : 0), field.line,
          field.column + static_cast<int>(first)};
}

AntennaText::AntennaText(const std::string& file) : file_(file), text_(readWholeText(file, kMaxFileBytes)) {
  if (text_.compare(0, 3, "\xEF\xBB\xBF") == 0) text_.erase(0, 3);
  std::replace_if(text_.begin(), text_.end(), isForeign, '?');
  const std::string_view text = text_;
  int number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    const TextField line = restOf({text.substr(begin, end - begin), number, 1}, 0);
    if (const std::size_t zero = line.text.find('\0'); zero != std::string_view::npos) {
      throw Error(ErrorCode::bad_input, {file, number, line.column + static_cast<int>(zero)},
                  "a zero byte: this is not a text file");
    }
    if (!line.text.empty() && line.text.front() != '#') lines_.push_back(line);
    begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
  }
}

std::vector<TextField> wordsOf(const TextField& line) {
  std::vector<TextField> words;
  for (std::size_t begin = line.text.find_first_not_of(kBlanks); begin < line.text.size();) {
    const std::size_t end = std::min(line.text.find_first_of(kBlanks, begin), line.text.size());
    words.push_back({line.text.substr(begin, end - begin), line.line, line.column + static_cast<int>(begin)});
    begin = line.text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<double> numberIn(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return {};
  return value;
}

std::string upperCase(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

}  // namespace emscape::scenario
