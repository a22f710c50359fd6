/// Rows of comma-separated text, or of text with another separator.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/unended_line.h"

namespace emscape::document {

/// A cell without surrounding blanks and quotes; a view of the reader's text.
struct CsvCell {
  std::string_view text;
  int column = 1;  ///< of its first character, counted in characters from 1; for an empty cell, the beginning
                   ///< of the cell
};

struct CsvRow {
  int line = 0;                ///< from 1
  std::vector<CsvCell> cells;  ///< at least one
};

/// Lines end in LF, CRLF or CR. Lines whose cells are all empty and lines that begin with # are left out. A
/// cell in double quotes may have commas, and double quotes that are written twice (RFC 4180), but no line
/// ends: a quote that is not closed on its line has no special meaning.
class CsvReader {
 public:
  /// @param text  must outlive the reader; both must outlive the cells
  explicit CsvReader(std::string_view text, char separator = ',') : text_(text), separator_(separator) {}

  /// Reads the next row into `row`, whose memory is reused. @return false at the end
  bool next(CsvRow& row);
  /// Lines read so far.
  int lines() const { return line_; }
  /// unendedLineTextOf() the text, and its unendedLineWarning(). @param what  "a row"
  std::string unendedText(const char* what) const { return unendedLineTextOf(text_, what); }
  std::string unendedWarning(const std::string& file, const char* what) const {
    return unendedLineWarning(file, text_, what);
  }

 private:
  void split(std::string_view line, std::vector<CsvCell>& cells);

  std::string_view text_;
  char separator_;
  std::deque<std::string> unquoted_;  ///< cells with doubled quotes
  std::size_t begin_ = 0;
  int line_ = 0;
};

/// The separator of tables of other programs: semicolon or tab, if the first line that is no comment has more
/// of them than commas; else comma.
char separatorOf(std::string_view text);

struct CsvFault {
  int column = 1;  ///< counted in characters from 1
  std::string message;
};

/// Names of the columns in the header of a file, which is searched for in its first 4096 bytes; none if the
/// file cannot be read or has no header.
std::vector<std::string> csvColumnsOf(const std::string& file);

/// The fault that a header line has whatever its columns mean: another separator than commas, or a column
/// without a name.
std::optional<CsvFault> headerFault(const std::vector<CsvCell>& header);

}  // namespace emscape::document
