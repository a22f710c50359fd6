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

TEST(Csv, LeavesOutLinesWithoutValues) {
  EXPECT_EQ(rowsOf("a,b\n1,2\n,,\n , \"\",\n3,\n"), "1:1'a'3'b';2:1'1'3'2';5:1'3'3'';");
}

TEST(Csv, CellsMayBeQuoted) {
  EXPECT_EQ(rowsOf("\"t_s\", \"a, b\" ,\"\"\n"), "1:1't_s'8'a, b'16'';");
  EXPECT_EQ(rowsOf("\"say \"\"so\"\"\",\" 1 \"\r\n\"2\",\"\"\"\"\n"), "1:1'say \"so\"'14'1';2:1'2'5'\"';");
}

TEST(Csv, AQuoteThatIsNotClosedIsACharacter) {
  EXPECT_EQ(rowsOf("\"a,b\n\"c\"d,e\"\n\"\"\",f\n"), "1:1'\"a'4'b';2:1'\"c\"d'6'e\"';3:1'\"\"\"'5'f';");
}

TEST(Csv, TellsALastRowWithoutALineEnd) {
  for (const char* const ended : {"", "a\n1\n", "a\r\n1\r\n", "a\n1\n# end", "a\n1\n  "})
    EXPECT_EQ(CsvReader(ended).unendedText("a row"), "") << ended;
  for (const char* const cut : {"a\n1", "a\r\n1", "a\r1"})
    EXPECT_EQ(
        CsvReader(cut).unendedText("a row").rfind("line 2, a row, has no end: if the file was cut there", 0),
        0u)
        << cut;
}

TEST(Csv, AHeaderHasCommasAndNames) {
  const auto faultOf = [](const std::string& text) {
    CsvReader reader(text);
    CsvRow row;
    if (!reader.next(row)) return std::string("no header");
    const std::optional<CsvFault> fault = headerFault(row.cells);
    return fault ? std::to_string(fault->column) + ": " + fault->message : "";
  };
  EXPECT_EQ(faultOf("t_s,height_msl_m\n"), "");
  EXPECT_EQ(faultOf("t_s\n"), "");
  EXPECT_EQ(faultOf(" t_s;height_msl_m\n"),
            "2: columns are separated by commas, not semicolons; numbers have decimal points");
  EXPECT_EQ(faultOf("t_s\theight_msl_m\n"),
            "1: columns are separated by commas, not tabs; numbers have decimal points");
  EXPECT_EQ(faultOf("t_s,height_msl_m,\n"), "18: column 3 has no name");
}

}  // namespace
}  // namespace emscape::document
