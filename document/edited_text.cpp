#include "document/edited_text.h"

#include <algorithm>

#include "document/text_file.h"

namespace emscape::document {

namespace {

/// The bytes at which the lines of a text begin.
std::vector<std::size_t> lineBegins(const std::string& text) {
  std::vector<std::size_t> begins{0};
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    begins.push_back(at + 1);
  return begins;
}

/// The byte at a line and column (characters).
std::size_t offsetOf(const std::string& text, const std::vector<std::size_t>& lines, int line, int column) {
  const auto index = static_cast<std::size_t>(std::max(line, 1) - 1);
  std::size_t at = index < lines.size() ? lines[index] : text.size();
  for (int i = 1; i < column && at < text.size(); ++i) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80) ++at;
  }
  return at;
}

SourceLocation locationOf(const std::string& file, const std::string& text,
                          const std::vector<std::size_t>& lines, std::size_t offset) {
  const auto line = std::upper_bound(lines.begin(), lines.end(), offset) - 1;
  const std::string_view before = std::string_view(text).substr(*line, offset - *line);
  return {file, static_cast<int>(line - lines.begin()) + 1, static_cast<int>(characterCount(before)) + 1};
}

}  // namespace

EditedText::EditedText(std::string file, std::string text)
    : file_(std::move(file)), original_(text), text_(std::move(text)) {}

void EditedText::apply(const Splice& splice, const std::string& label) {
  text_.replace(splice.begin, splice.end - splice.begin, splice.text);
  if (changes_.empty()) original_lines_ = lineBegins(original_);
  lines_ = lineBegins(text_);
  Change merged{splice.begin, splice.end, splice.begin, splice.end, label};
  std::vector<Change> kept;
  std::ptrdiff_t shift = 0;  // shift of the bytes before the splice, from text() to the file
  bool met = false;
  for (const Change& change : changes_) {
    if (change.new_end < splice.begin || change.new_begin > splice.end) {
      kept.push_back(change);
      if (change.new_end < splice.begin) {
        shift = static_cast<std::ptrdiff_t>(change.end) - static_cast<std::ptrdiff_t>(change.new_end);
      }
      continue;
    }
    // The part of the splice outside the change belongs to the file.
    const std::size_t before = change.new_begin > merged.new_begin ? change.new_begin - merged.new_begin : 0;
    if (!met) merged.begin = change.begin - before;
    merged.new_begin = std::min(merged.new_begin, change.new_begin);
    merged.new_end = std::max(splice.end, change.new_end);
    merged.end = change.end + (splice.end > change.new_end ? splice.end - change.new_end : 0);
    met = true;
  }
  if (!met) {
    merged.begin = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(splice.begin) + shift);
    merged.end = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(splice.end) + shift);
  }
  const std::ptrdiff_t growth = static_cast<std::ptrdiff_t>(splice.text.size()) -
                                static_cast<std::ptrdiff_t>(splice.end - splice.begin);
  const auto grown = [growth](std::size_t at) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + growth);
  };
  for (Change& change : kept) {
    if (change.new_begin <= splice.end) continue;
    change.new_begin = grown(change.new_begin);
    change.new_end = grown(change.new_end);
  }
  merged.new_end = grown(merged.new_end);
  const auto next = std::find_if(kept.begin(), kept.end(),
                                 [&](const Change& change) { return change.new_begin > merged.new_begin; });
  kept.insert(next, std::move(merged));
  changes_ = std::move(kept);
}

SourceLocation EditedText::originOf(const SourceLocation& location) const {
  if (changes_.empty() || location.file != file_ || location.line == 0) return location;
  const std::size_t at = offsetOf(text_, lines_, location.line, location.column);
  std::size_t origin = at;
  for (const Change& change : changes_) {
    if (at < change.new_begin) break;
    if (at < change.new_end) return {change.label, 0, 0};
    origin = change.end + (at - change.new_end);
  }
  return locationOf(file_, original_, original_lines_, origin);
}

}  // namespace emscape::document
