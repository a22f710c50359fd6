#include "base/text/csv_cell.h"

#include <gtest/gtest.h>

namespace emscape {
namespace {

TEST(CsvCell, FormulasAreTextForASpreadsheet) {
  for (const char* formula : {"=cmd|calc", "@SUM(1)", "+1+cmd", "-2+3", "\t=1", "-", "=1"})
    EXPECT_EQ(csvCell(formula), std::string("'") + formula);
  EXPECT_EQ(csvCell("=HYPERLINK(\"a\",1)"), "\"'=HYPERLINK(\"\"a\"\",1)\"");
}

TEST(CsvCell, NumbersAndNamesAreKept) {
  for (const char* text : {"-90", "+1.5e3", "-0.25", "radar 1", "a=b", "", "'quoted'"})
    EXPECT_EQ(csvCell(text), text);
}

}  // namespace
}  // namespace emscape
