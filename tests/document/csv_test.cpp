#include "document/csv.h"

#include <gtest/gtest.h>

#include <string>

namespace emscape::document {
namespace {

/// "line:column text|column text ..." of all rows.
std::string rowsOf(const std::string& text) {
  std::string all;
  CsvReader reader(text);
  for (CsvRow row; reader.next(row);) {
    all += std::to_string(row.line) + ":";
    for (const CsvCell& cell : row.cells)
      all += std::to_string(cell.column) + "'" + std::string(cell.text) + "'";
    all += ";";
  }
  return all;
}

TEST(Csv, SplitsAtCommasAndTrimsBlanks) {
  EXPECT_EQ(rowsOf("a, b ,c\n1,,\t3"), "1:1'a'4'b'7'c';2:1'1'3''5'3';");
}

TEST(Csv, LeavesOutCommentsAndEmptyLines) {
  EXPECT_EQ(rowsOf("# c\n\n  \n a\n  # d\nb\n"), "4:2'a';6:1'b';");
  EXPECT_EQ(rowsOf(""), "");
}

TEST(Csv, KnowsEveryLineEndAndCountsCharacters) {
  EXPECT_EQ(rowsOf("a\r\nb\rc\nd"), "1:1'a';2:1'b';3:1'c';4:1'd';");
  EXPECT_EQ(rowsOf("\xC3\xA9,x"), "1:1'\xC3\xA9'3'x';");
}

}  // namespace
}  // namespace emscape::document
