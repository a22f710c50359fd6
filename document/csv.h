/// Comma-separated text, one row after another.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace emscape::document {

/// A cell without surrounding blanks; a view of the reader's text.
struct CsvCell {
  std::string_view text;
  int column = 1;  ///< of its first character, counted in characters from 1; for an empty cell, the beginning
                   ///< of the cell
};

struct CsvRow {
  int line = 0;                ///< from 1
  std::vector<CsvCell> cells;  ///< at least one
};

/// Lines end in LF, CRLF or CR. Lines of blanks and lines that begin with # are left out. Quotes have no
/// special meaning: a comma always separates cells.
class CsvReader {
 public:
  /// @param text  must outlive the reader and its cells
  explicit CsvReader(std::string_view text) : text_(text) {}

  /// Reads the next row into `row`, whose memory is reused. @return false at the end
  bool next(CsvRow& row);
  /// Lines read so far.
  int lines() const { return line_; }

 private:
  std::string_view text_;
  std::size_t begin_ = 0;
  int line_ = 0;
};

}  // namespace emscape::document
