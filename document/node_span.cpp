#include "document/node_span.h"

#include <algorithm>
#include <string>

#include "emscape/base/error.h"

namespace emscape::document {

namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n";

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::bad_input, "the file cannot be edited here: " + why);
}

bool isBlank(char c) {
  return kWhiteSpace.find(c) != std::string_view::npos;
}

std::size_t endOfQuoted(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote == '"' || i + 1 == text.size() || text[i + 1] != '\'') return i + 1;
      ++i;
    }
  }
  refuse("a text in quotes has no end");
}

/// A text without quotes, perhaps over several lines: except for blanks, its characters are those of the
/// file.
std::size_t endOfPlain(std::string_view text, std::size_t begin, std::string_view value) {
  std::size_t i = begin, end = begin;
  for (const char c : value) {
    if (isBlank(c)) continue;
    while (i < text.size() && isBlank(text[i])) ++i;
    if (i == text.size() || text[i] != c) refuse("a text without quotes is not where it should be");
    end = ++i;
  }
  return end;
}

std::size_t endOfLine(std::string_view text, std::size_t from) {
  std::size_t end = std::min(text.find('\n', from), text.size());
  if (end > from && text[end - 1] == '\r') --end;
  return end;
}

/// A text in block style: the lines that are indented at least as far as its first.
std::size_t endOfBlockText(std::string_view text, std::size_t begin, std::string_view value) {
  std::size_t end = endOfLine(text, begin);
  if (text.substr(begin, end - begin).find_first_of("0123456789") != std::string_view::npos) {
    refuse("a block text has an indentation indicator");
  }
  if (value.find_first_not_of('\n') == std::string_view::npos) return end;
  std::size_t indentation = 0;
  for (std::size_t line = text.find('\n', begin); line != std::string_view::npos;
       line = text.find('\n', line + 1)) {
    const std::size_t first = line + 1, line_end = endOfLine(text, first);
    const std::size_t word = std::min(text.find_first_not_of(' ', first), text.size());
    if (word >= line_end) continue;
    if (indentation == 0) indentation = word - first;
    if (word - first < indentation || indentation == 0) break;
    end = line_end;
  }
  return end;
}

std::size_t endOfFlow(std::string_view text, std::size_t from, char closing) {
  for (std::size_t i = from; i < text.size(); ++i) {
    if (text[i] == closing) return i + 1;
    if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (!isBlank(text[i]) && text[i] != ',' && text[i] != ':') {
      break;
    }
  }
  refuse("a bracket has no end");
}

std::size_t lengthOfNull(std::string_view text) {
  for (const std::string_view word : {"null", "Null", "NULL", "~"}) {
    if (text.substr(0, word.size()) == word) return word.size();
  }
  return 0;
}

std::size_t endOfCollection(std::string_view text, const DocumentNode& node) {
  std::size_t end = node.position.offset + 1;
  if (!node.entries.empty()) end = valueSpanOf(text, node.entries.back()).end;
  if (!node.items.empty()) end = spanOf(text, *node.items.back()).end;
  if (!isFlow(text, node)) return end;
  return endOfFlow(text, end, node.kind == NodeKind::map ? '}' : ']');
}

}  // namespace

bool isFlow(std::string_view text, const DocumentNode& node) {
  const char first = node.position.offset < text.size() ? text[node.position.offset] : '\0';
  return first == (node.kind == NodeKind::map ? '{' : '[');
}

std::size_t afterColon(std::string_view text, const MapEntry& entry) {
  const std::size_t begin = entry.position.offset;
  if (begin >= text.size()) refuse("a key is not where it should be");
  const bool in_quotes = text[begin] == '"' || text[begin] == '\'';
  std::size_t i = in_quotes ? endOfQuoted(text, begin) : endOfPlain(text, begin, entry.key);
  while (i < text.size() && isBlank(text[i])) ++i;
  if (i == text.size() || text[i] != ':') refuse("a key has no colon, or an anchor before it");
  return i + 1;
}

Span spanOf(std::string_view text, const DocumentNode& node) {
  if (node.anchored) refuse("there is an anchor (&) or an alias (*); write the value out in the file");
  const std::size_t begin = node.position.offset;
  if (begin >= text.size()) refuse("a value is not where it should be");
  if (node.kind == NodeKind::map || node.kind == NodeKind::sequence)
    return {begin, endOfCollection(text, node)};
  if (node.kind == NodeKind::null) {
    const std::size_t length = lengthOfNull(text.substr(begin));
    if (length == 0) refuse("an item of a list is missing");
    return {begin, begin + length};
  }
  if (!node.quoted) return {begin, endOfPlain(text, begin, node.text)};
  if (text[begin] == '"' || text[begin] == '\'') return {begin, endOfQuoted(text, begin)};
  if (text[begin] == '|' || text[begin] == '>') return {begin, endOfBlockText(text, begin, node.text)};
  refuse("there is a tag");
}

Span valueSpanOf(std::string_view text, const MapEntry& entry) {
  if (entry.value->kind != NodeKind::null || entry.value->anchored) return spanOf(text, *entry.value);
  const std::size_t colon = afterColon(text, entry);
  const std::size_t word = std::min(text.find_first_not_of(" \t", colon), text.size());
  const std::size_t length = lengthOfNull(text.substr(word));
  return length == 0 ? Span{colon, colon} : Span{word, word + length};
}

}  // namespace emscape::document
