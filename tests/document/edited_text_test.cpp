#include "document/edited_text.h"

#include <gtest/gtest.h>

#include <string>

namespace emscape::document {
namespace {

std::string originOf(const EditedText& text, int line, int column) {
  return toString(text.originOf({text.file(), line, column}));
}

/// Replaces the first occurrence of a part of the text.
void replace(EditedText& text, const std::string& part, const std::string& other, const std::string& label) {
  const std::size_t at = text.text().find(part);
  ASSERT_NE(at, std::string::npos);
  text.apply({at, at + part.size(), other}, label);
}

TEST(EditedText, WithoutChangesHasItsOwnLocations) {
  const EditedText text("a.yaml", "a: 1\nb: 2\n");
  EXPECT_EQ(originOf(text, 2, 4), "a.yaml:2:4");
}

TEST(EditedText, KnowsWhereEachLineWasBeforeChangesOfTheLinesAboveIt) {
  EditedText text("a.yaml", "a: 1\nb: \xC3\xA9\xC3\xA9 2\n\nc: 3\nd: 4");
  replace(text, "1", "[\n  1,\n  2]", "--set a");
  replace(text, "c: 3\n", "", "--set c");
  ASSERT_EQ(text.text(), "a: [\n  1,\n  2]\nb: \xC3\xA9\xC3\xA9 2\n\nd: 4");
  EXPECT_EQ(originOf(text, 1, 1), "a.yaml:1:1");
  EXPECT_EQ(originOf(text, 1, 4), "--set a");
  EXPECT_EQ(originOf(text, 3, 3), "--set a");
  EXPECT_EQ(originOf(text, 4, 1), "a.yaml:2:1");
  EXPECT_EQ(originOf(text, 4, 7), "a.yaml:2:7") << "columns are characters";
  EXPECT_EQ(originOf(text, 5, 1), "a.yaml:3:1") << "an empty line";
  EXPECT_EQ(originOf(text, 6, 4), "a.yaml:5:4");
  EXPECT_EQ(originOf(text, 6, 5), "a.yaml:5:5") << "the end of the text";
  EXPECT_EQ(originOf(text, 9, 1), "a.yaml:5:5") << "beyond the end";
  EXPECT_EQ(toString(text.originOf({"b.csv", 4, 1})), "b.csv:4:1");
}

TEST(EditedText, OfATextThatWasEmptyHasOneLine) {
  EditedText text("a.yaml", "");
  text.apply({0, 0, "a: 1\n"}, "--set a");
  EXPECT_EQ(originOf(text, 1, 1), "--set a");
  EXPECT_EQ(originOf(text, 2, 1), "a.yaml:1:1");
}

}  // namespace
}  // namespace emscape::document
