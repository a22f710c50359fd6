#include "apps/view/values/line_breaks.h"

#include <gtest/gtest.h>

namespace emscape::view {
namespace {

/// Characters as wide as 1.
std::string broken(const std::string& text, float width) {
  return withLineBreaks(text, width, [](std::string_view part) { return static_cast<float>(part.size()); });
}

TEST(LineBreaks, KeepANumberAndItsUnitInOneLine) {
  for (float width = 1; width < 40; ++width) {
    std::string text = broken("ground at 12,345.5 m, loss -3.5 dB at 36.3235 N", width);
    if (width < 12) continue;  // of the longest part
    for (const char* part : {"12,345.5 m,", "-3.5 dB", "36.3235 N"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  EXPECT_EQ(broken("at 5 m", 5), "at\n5 m");
  EXPECT_EQ(broken("of 12 345 m now", 9), "of\n12 345 m\nnow");
}

TEST(LineBreaks, AreAtBlanksAndInWordsThatAreTooLong) {
  EXPECT_EQ(broken("one two", 7), "one two");
  EXPECT_EQ(broken("one two three", 8), "one two\nthree");
  EXPECT_EQ(broken("in P.526 of 5 m", 9), "in P.526\nof 5 m") << "a name with a number is none";
  EXPECT_EQ(broken("a\n\nb c", 1), "a\n\nb\nc");
  EXPECT_EQ(broken("in /folder/inner/file", 10), "in\n/folder/\ninner/file");
  EXPECT_EQ(broken("abcdef", 4), "abcd\nef");
  EXPECT_EQ(broken("1 2 3 4 5 6", 3), "1 2\n3 4\n5 6") << "a row of numbers";
  EXPECT_EQ(broken("\xC3\xA4\xC3\xB6", 2), "\xC3\xA4\n\xC3\xB6") << "not in a character";
  EXPECT_EQ(broken("", 3), "");
  EXPECT_EQ(broken("ab", 0), "a\nb") << "a column without width";
}

}  // namespace
}  // namespace emscape::view
