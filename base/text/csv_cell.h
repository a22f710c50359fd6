/// Writing of CSV.
#pragma once

#include <cstdlib>
#include <string>

namespace emscape {

/// True for a text that a spreadsheet takes for a formula and is no number.
inline bool isSpreadsheetFormula(const std::string& text) {
  if (text.empty() || std::string("=+-@\t\r").find(text.front()) == std::string::npos) return false;
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end == text.c_str() || *end != '\0';
}

/// A text as a cell of a CSV file (RFC 4180), quoted if it contains a comma, a quote or a line end. An
/// apostrophe is put before a formula: spreadsheets then show its text.
inline std::string csvCell(const std::string& given) {
  const std::string text = isSpreadsheetFormula(given) ? "'" + given : given;
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace emscape
