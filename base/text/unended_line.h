/// What tells of a table that was cut in its last row.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace emscape {

/// Told of a last line without a line end, whose numbers may have lost digits; to follow what the line is.
constexpr char kUnended[] =
    " has no end: if the file was cut there, its values are wrong; remove it, or end the line";

/// @param line  its number, from 1
/// @param what  the line is: "a row"
inline std::string unendedLineText(long long line, const char* what) {
  return fmt::format("line {}, {},{}", line, what, kUnended);
}

/// The number of a last line without an end; 0: it has one, is a comment (#) or has blanks alone.
inline long long unendedLineOf(std::string_view text) {
  const std::size_t before = text.find_last_of("\r\n");
  const std::string_view last = text.substr(before == std::string_view::npos ? 0 : before + 1);
  const std::size_t begin = last.find_first_not_of(" \t");
  if (begin == std::string_view::npos || last[begin] == '#') return 0;
  const bool has_newlines = text.find('\n') != std::string_view::npos;
  return 1 + std::count(text.begin(), text.end(), has_newlines ? '\n' : '\r');
}

/// Of a whole text; empty: unendedLineOf() is 0.
inline std::string unendedLineTextOf(std::string_view text, const char* what) {
  const long long line = unendedLineOf(text);
  return line == 0 ? "" : unendedLineText(line, what);
}

/// A warning "FILE:LINE:1: a row has no end..."; empty: unendedLineOf() is 0.
inline std::string unendedLineWarning(const std::string& file, std::string_view text, const char* what) {
  const long long line = unendedLineOf(text);
  return line == 0 ? "" : fmt::format("{}:{}:1: {}{}", file, line, what, kUnended);
}

}  // namespace emscape
