#include "emscape/playback/frames/inputs.h"

#include "emscape/playback/frames/frame_source.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;

class JsonFiles : public testing::Test {
 protected:
  JsonFiles() {
    folder_.write("a.view.json", "{}");
    folder_.write("view.json", R"({"schema_version": 1, "camera": "orbit"})");
    folder_.write("VIEW.JSON", R"({"schema_version": 1, "camera": "orbit"})");
    folder_.write("colours.json",
                  R"({"schema_version": 1, "domain": "relative", "opacity": [], "colors": []})");
    folder_.write("field_0001.raw.json", R"({"dims": [2, 2, 2]})");
    folder_.write("series.json", R"({"format_version": 2, "recipe": {}})");
    folder_.write("scenario.json", R"({"schema_version": 1, "region": {}})");
  }
  TemporaryFolder folder_;
};

TEST_F(JsonFiles, AreRecognisedByNameAndKeys) {
  const auto content = [this](const char* name) { return jsonContentOf(folder_ / name); };
  EXPECT_EQ(content("a.view.json"), JsonContent::view);
  EXPECT_EQ(content("view.json"), JsonContent::view);
  EXPECT_EQ(content("VIEW.JSON"), JsonContent::view);
  EXPECT_EQ(content("colours.json"), JsonContent::transfer);
  EXPECT_EQ(content("field_0001.raw.json"), JsonContent::header);
  EXPECT_EQ(content("series.json"), JsonContent::series);
  EXPECT_EQ(content("scenario.json"), JsonContent::other);
  EXPECT_EQ(content("none.json"), JsonContent::other);
  EXPECT_EQ(content("."), JsonContent::other);
}

TEST_F(JsonFiles, OtherThanScenariosAreRefusedWithTheirUse) {
  const auto fault = [this](const char* name) {
    return errorOf([&] { requireScenarioFile(folder_ / name); }, ErrorCode::bad_input);
  };
  const std::string view = ": a view file, not a scenario: `render` and `view` read it with --state";
  EXPECT_EQ(fault("a.view.json"), (folder_ / "a.view.json") + view);
  EXPECT_EQ(fault("VIEW.JSON"), (folder_ / "VIEW.JSON") + view);
  EXPECT_THAT(
      fault("colours.json"),
      HasSubstr(": a transfer function, not a scenario: `render` and `view` read it with --transfer"));
  EXPECT_THAT(fault("field_0001.raw.json"),
              HasSubstr(": the header of a volume: open field_0001.raw beside it"));
  EXPECT_THAT(fault("series.json"),
              HasSubstr(": describes a series of volumes, not a scenario: open its folder"));
  EXPECT_EQ(fault("scenario.json"), "");
}

TEST_F(JsonFiles, OtherThanScenariosAreRefusedAsInputs) {
  FrameSelection selection;
  selection.input = folder_ / "a.view.json";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }), HasSubstr(": a view file, not a scenario"));
}

}  // namespace
}  // namespace emscape::playback::test
