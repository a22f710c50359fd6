#include "document/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/files/file_reading.h"
#include "document/text_file.h"

namespace emscape::document {
namespace {

constexpr std::size_t kMaxLinesBytes = std::size_t{64} << 20;
constexpr std::string_view kLineBlanks = " \t";

/// True for bytes outside ASCII and control characters, except line ends, tabs, and zeros, which mark binary
/// files.
bool isForeign(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x7F || (byte < 0x20 && c != '\0' && c != '\t' && c != '\n' && c != '\r');
}

}  // namespace

std::string_view withoutBlanks(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kLineBlanks), text.size());
  const std::size_t end = text.find_last_not_of(kLineBlanks) + 1;  // npos + 1 is 0
  return text.substr(begin, end > begin ? end - begin : 0);
}

TextField restOf(const TextField& field, std::size_t offset) {
  const std::size_t first = std::min(field.text.find_first_not_of(kLineBlanks, offset), field.text.size());
  return {withoutBlanks(field.text.substr(first)), field.line, field.column + static_cast<int>(first)};
}

TextLines::TextLines(const std::string& file) : file_(file), text_(readWholeText(file, kMaxLinesBytes)) {
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
  for (std::size_t begin = line.text.find_first_not_of(kLineBlanks); begin < line.text.size();) {
    const std::size_t end = std::min(line.text.find_first_of(kLineBlanks, begin), line.text.size());
    words.push_back({line.text.substr(begin, end - begin), line.line, line.column + static_cast<int>(begin)});
    begin = line.text.find_first_not_of(kLineBlanks, end);
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

std::optional<double> numberOrCommaIn(std::string_view text) {
  std::string with_point(text);
  if (std::count(text.begin(), text.end(), ',') == 1 && text.find('.') == std::string_view::npos)
    std::replace(with_point.begin(), with_point.end(), ',', '.');
  return numberIn(with_point);
}

std::string upperCase(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

}  // namespace emscape::document
