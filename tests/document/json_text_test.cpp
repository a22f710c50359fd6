#include "document/json_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "document/document.h"
#include "document/schema_check.h"
#include "document/section.h"

namespace emscape::document {
namespace {

using Json = nlohmann::ordered_json;

TEST(JsonText, ShortValuesAreOnOneLine) {
  Json root;
  root["number"] = 1.5;
  root["text"] = "a \"b\"\n";
  root["empty"] = Json::array();
  root["short"] = {{{"at", 1}, {"x", true}}};
  EXPECT_EQ(jsonText(root),
            "{\n  \"number\": 1.5,\n  \"text\": \"a \\\"b\\\"\\n\",\n  \"empty\": [],\n"
            "  \"short\": [{\"at\": 1, \"x\": true}]\n}\n");
}

TEST(JsonText, LongListsHaveOneLinePerItem) {
  Json root;
  for (int i = 0; i < 20; ++i) root["points"].push_back({{"at", i}, {"opacity", 0.5}});
  const std::string text = jsonText(root);
  EXPECT_THAT(text, testing::HasSubstr("  \"points\": [\n    {\"at\": 0, \"opacity\": 0.5},\n"));
  EXPECT_EQ(Json::parse(text), root);
}

TEST(JsonText, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_NO_THROW(Json::parse(jsonText({{"name", "\xC3"}})));
}

TEST(JsonText, ShortNumbersReadBackAsTheSameFloat) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t bits = random();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const double read = Json::parse(shortNumber(value).dump()).get<double>();
    ASSERT_EQ(static_cast<float>(read), value);
  }
  EXPECT_EQ(shortNumber(0.1F).dump(), "0.1");
}

/// The errors in a document with one key, and the value that is read.
std::pair<std::string, std::optional<bool>> readBoolean(const std::string& value) {
  const ObjectSpec spec{"thing", "", {spec::optional("on", spec::simple(ValueType::boolean), "")}};
  ProblemList problems;
  const std::string file = "a.yaml";
  const DocumentNodePtr root = readDocument(file, "on: " + value + "\n", problems);
  checkObject(file, *root, spec, problems);
  const std::vector<Problem> all = problems.inOrder();
  return {all.empty() ? "" : toString(all.front().location) + ": " + all.front().message,
          Section(file, root.get(), spec).optionalBoolean("on")};
}

TEST(Schema, OnlyTrueAndFalseAreBooleans) {
  EXPECT_EQ(readBoolean("true"), std::make_pair(std::string(), std::optional<bool>(true)));
  EXPECT_EQ(readBoolean("false"), std::make_pair(std::string(), std::optional<bool>(false)));
  EXPECT_EQ(readBoolean("yes").first, "a.yaml:1:5: 'on' must be true or false, not 'yes'");
  EXPECT_EQ(readBoolean("\"true\"").first,
            "a.yaml:1:5: 'on' must be true or false, not the quoted text 'true'");
  EXPECT_EQ(readBoolean("1").first, "a.yaml:1:5: 'on' must be true or false, not '1'");
}

}  // namespace
}  // namespace emscape::document
