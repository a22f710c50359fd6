/// Writing of CSV.
#pragma once

#include <string>

namespace emscape {

/// A text as a cell of a CSV file (RFC 4180), quoted if it contains a comma, a quote or a line end.
inline std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace emscape
