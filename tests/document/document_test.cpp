#include "document/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "document/schema_check.h"

namespace emscape::document {
namespace {

using ::testing::HasSubstr;

std::string faultOf(const std::string& text) {
  ProblemList problems;
  readDocument("a.yaml", text, problems);
  const std::vector<Problem> all = problems.inOrder();
  return all.empty() ? "" : toString(all.front().location) + ": " + all.front().message;
}

TEST(Document, KeepsLocationsOfKeysAndValues) {
  ProblemList problems;
  const std::string text = "# \xC3\xA9\nfirst: 1\nsecond: [a, \"b\"]\n";
  const DocumentNodePtr root = readDocument("a.yaml", text, problems);
  ASSERT_TRUE(root);
  ASSERT_EQ(root->entries.size(), 2u);
  EXPECT_EQ(root->entries[1].key, "second");
  EXPECT_EQ(root->entries[1].position.line, 3);
  EXPECT_EQ(text.substr(root->entries[1].position.offset, 6), "second");
  const DocumentNode& item = *root->entries[1].value->items[1];
  EXPECT_EQ(item.position.column, 13);
  EXPECT_EQ(text[item.position.offset], '"');
  EXPECT_TRUE(item.quoted);
}

TEST(Document, DistinguishesAnchors) {
  ProblemList problems;
  const DocumentNodePtr root = readDocument("a.yaml", "a: &x 1\nb: *x\nc: 2\n", problems);
  ASSERT_TRUE(root);
  EXPECT_TRUE(root->entries[0].value->anchored);
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
  EXPECT_FALSE(root->entries[2].value->anchored);
}

TEST(Document, ReadsPairsOfSurrogateEscapesAsJsonWritesThem) {
  ProblemList problems;
  const std::string text =
      R"({"a\\ud83c": "\ud83c\udf89 \uD83C\uDF89", "b": ["it's \u00fc", "\ud83d\ude00"], "c": 'x\ud83c\udf89', "d": 1})";
  const DocumentNodePtr root = readDocument("a.json", text, problems);
  ASSERT_TRUE(root);
  ASSERT_EQ(root->entries.size(), 4u);
  EXPECT_EQ(root->entries[0].key, R"(a\ud83c)");
  EXPECT_EQ(root->entries[0].value->text, "\xF0\x9F\x8E\x89 \xF0\x9F\x8E\x89");
  EXPECT_EQ(root->entries[1].value->items[0]->text, "it's \xC3\xBC");
  EXPECT_EQ(root->entries[1].value->items[1]->text, "\xF0\x9F\x98\x80");
  EXPECT_EQ(root->entries[2].value->text, R"(x\ud83c\udf89)") << "no escape between single quotes";
  const TextPosition& position = root->entries[3].value->position;
  EXPECT_EQ(text[position.offset], '1') << "positions are those of the file";
  EXPECT_EQ(position.column, static_cast<int>(position.offset) + 1);
}

TEST(Document, RefusesHalfASurrogatePair) {
  const std::string why = " is not a character, but one half of a surrogate pair";
  EXPECT_EQ(faultOf("{\"a\": 1,\n \"b\": \"\\ud83c\\udf89 \\ud83c.\"}"),
            "a.yaml:2:21: not valid YAML: \\ud83c" + why);
  EXPECT_EQ(faultOf("b: \"\xC3\xBC \\udf89\"\n"), "a.yaml:1:7: not valid YAML: \\udf89" + why);
  EXPECT_EQ(faultOf("b: \"\\U00110000\"\n"), "a.yaml:1:5: not valid YAML: \\U00110000 is not a character");
  EXPECT_EQ(faultOf("b: \"\\ud83c\\ud83c\"\n"), "a.yaml:1:5: not valid YAML: \\ud83c" + why);
  EXPECT_EQ(faultOf("name: \"\\ud83c\\udf89\"\n"),
            "a.yaml:1:8: not valid YAML: \\ud83c\\udf89 is a pair of surrogates, which YAML writes as "
            "\\U0001f389");
}

TEST(Document, FaultsOfJsonDoNotNameYaml) {
  ProblemList problems;
  readDocument("a.json", "{\"a\": [1, 2}", problems);
  EXPECT_THAT(problems.inOrder().at(0).message, HasSubstr("not valid JSON: "));
}

TEST(Document, ErrorsHaveLocations) {
  EXPECT_EQ(faultOf(""), "a.yaml:1:1: the file is empty");
  EXPECT_EQ(faultOf("a:\n\tb: 1\n"), "a.yaml:2:1: tab as indentation; use spaces");
  EXPECT_EQ(faultOf("a: !!int 3\n"), "a.yaml:1:4: tag 'tag:yaml.org,2002:int' is not allowed");
  EXPECT_THAT(faultOf("a: 1\n---\nb: 2\n"), HasSubstr("a second document begins here"));
  EXPECT_THAT(faultOf("a: [1, 2\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(faultOf("a: *none\n"), HasSubstr("a.yaml:1:"));
}

TEST(Document, TextOfManyErrorsTellsTwentyAndTheNumberOfTheOthers) {
  ProblemList problems;
  for (int line = 1; line <= 23; ++line) problems.addError({"a.yaml", line, 1}, std::string(2000, 'x'));
  problems.addWarning({"a.yaml", 1, 1}, "is no error");
  const std::string text = errorsText(problems.inOrder());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 20);
  EXPECT_THAT(text, testing::StartsWith("a.yaml:1:1: xxx"));
  EXPECT_THAT(text, testing::EndsWith("\n3 further errors are not told"));
}

}  // namespace
}  // namespace emscape::document
