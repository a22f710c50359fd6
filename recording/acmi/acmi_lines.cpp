#include "recording/acmi/acmi_lines.h"

#include "recording/common/byte_source.h"

namespace emscape::interop {

std::optional<std::string_view> AcmiLines::take(std::string_view line, bool is_cut) {
  ++lines_;
  const bool is_joined = goes_on_;
  if (!is_joined) {
    begin_ = lines_;
    joined_.clear();
    is_too_long_ = false;
  }
  goes_on_ = !is_cut && !line.empty() && line.back() == '\\';
  if (!is_too_long_ && (is_cut || joined_.size() + line.size() > LineReader::kLongest)) {
    is_too_long_ = true;
    ++too_long_;
  }
  if (is_too_long_) return std::nullopt;
  if (!is_joined && !goes_on_) return line;
  if (goes_on_) line.remove_suffix(1);
  joined_ += line;
  if (!goes_on_) return joined_;
  joined_ += '\n';
  return std::nullopt;
}

std::string physicalAcmi(std::string_view line) {
  std::string text;
  text.reserve(line.size());
  for (const char c : line) {
    if (c == '\n') text += '\\';
    text += c;
  }
  return text;
}

}  // namespace emscape::interop
