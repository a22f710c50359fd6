#include "emscape/playback/autosave.h"

#include "base/utc.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// XDG_STATE_HOME in a folder of the test's.
class Autosave : public testing::Test {
 protected:
  Autosave() { setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1); }
  ~Autosave() override { unsetenv("XDG_STATE_HOME"); }

  const TemporaryFolder folder_;
};

TEST_F(Autosave, OutlivesItsProgramAndIsOffered) {
  const std::string input = quickScenario(folder_);
  EXPECT_FALSE(findAutosave(input));
  ViewState state;
  state.edits = {{"emitters.radar.power_w", "500"}};
  state.time_s = 3;
  autosave(input, state);
  state.edits.push_back({"emitters.radar.losses_db", "5"});
  autosave(input, state);

  const std::optional<AutosavedView> found = findAutosave(input);
  ASSERT_TRUE(found);
  EXPECT_EQ(viewStateText(found->state), viewStateText(state));
  EXPECT_FALSE(found->input_changed);
  EXPECT_TRUE(parseUtc_ms(found->written_utc)) << found->written_utc;
  // One file, under the name of the input.
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "state/emscape")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_THAT(entry.path().filename().string(), testing::StartsWith("scenario-"));
  }
  EXPECT_EQ(files, 1);

  removeAutosave(input);
  EXPECT_FALSE(findAutosave(input));
}

TEST_F(Autosave, BelongsToTheInputWhereverItIsCalledFrom) {
  const std::string input = quickScenario(folder_);
  EXPECT_EQ(autosaveFileOf(input), autosaveFileOf(folder_ / "state/../scenario.yaml"));
  EXPECT_EQ(autosaveFileOf(folder_.path().string()), autosaveFileOf(folder_.path().string()));
  EXPECT_NE(autosaveFileOf(input), autosaveFileOf(folder_ / "other/scenario.yaml"));
  autosave(input, {});
  EXPECT_FALSE(findAutosave(folder_ / "other/scenario.yaml"));
}

TEST_F(Autosave, SaysThatTheInputWasWrittenSince) {
  const std::string input = quickScenario(folder_);
  autosave(input, {});
  fs::last_write_time(input, fs::last_write_time(autosaveFileOf(input)) + std::chrono::seconds(5));
  EXPECT_TRUE(findAutosave(input)->input_changed);
}

TEST_F(Autosave, ADamagedOneIsAnErrorThatNamesIt) {
  const std::string input = quickScenario(folder_);
  autosave(input, {});
  writeFile(autosaveFileOf(input), "{\"schema_version\": 1, \"time_s\": ");
  EXPECT_THAT(errorOf([&] { findAutosave(input); }), HasSubstr(autosaveFileOf(input).string() + ":1:"));
}

TEST_F(Autosave, RelativeStateFoldersAreIgnored) {
  setenv("XDG_STATE_HOME", "state", 1);
  const char* home = std::getenv("HOME");
  const std::string before = home != nullptr ? home : "";
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(stateFolder(), "/home/somebody/.local/state/emscape");
  setenv("HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace emscape::playback::test
