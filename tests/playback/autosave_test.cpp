#include "playback/editing/autosave.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "base/text/utc.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// XDG_STATE_HOME in a folder of the test.
class Autosave : public testing::Test {
 protected:
  Autosave() { setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1); }
  ~Autosave() override { unsetenv("XDG_STATE_HOME"); }

  const TemporaryFolder folder_;
  Autosaves saves_;
};

TEST_F(Autosave, IsOfferedAfterItsProgramEnded) {
  const std::string input = quickScenario(folder_);
  EXPECT_FALSE(saves_.find(input));
  ViewState state;
  state.edits = {{"emitters.radar.power_w", "500"}};
  state.time_s = 3;
  saves_.keep(input, state);
  state.edits.push_back({"emitters.radar.losses_db", "5"});
  saves_.keep(input, state);

  const std::optional<AutosavedView> found = saves_.find(input);
  ASSERT_TRUE(found);
  EXPECT_EQ(viewStateText(found->state), viewStateText(state));
  EXPECT_FALSE(found->input_changed);
  EXPECT_TRUE(parseUtc_ms(found->written_utc)) << found->written_utc;
  // One file, under the name of the input.
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "state/emscape")) {
    if (!entry.is_regular_file()) continue;
    if (entry.path().extension() != ".lock") ++files;
    EXPECT_THAT(entry.path().filename().string(), testing::StartsWith("scenario-"));
  }
  EXPECT_EQ(files, 1);

  saves_.discard(input);
  EXPECT_FALSE(saves_.find(input));
}

TEST_F(Autosave, BelongsToTheInputWhereverItIsCalledFrom) {
  const std::string input = quickScenario(folder_);
  EXPECT_EQ(autosaveFileOf(input), autosaveFileOf(folder_ / "state/../scenario.yaml"));
  EXPECT_EQ(autosaveFileOf(folder_.path().string()), autosaveFileOf(folder_.path().string()));
  EXPECT_NE(autosaveFileOf(input), autosaveFileOf(folder_ / "other/scenario.yaml"));
  saves_.keep(input, {});
  EXPECT_FALSE(saves_.find(folder_ / "other/scenario.yaml"));
}

TEST_F(Autosave, SaysThatTheInputWasWrittenSince) {
  const std::string input = quickScenario(folder_);
  saves_.keep(input, {});
  fs::last_write_time(input, fs::last_write_time(autosaveFileOf(input)) + std::chrono::seconds(5));
  EXPECT_TRUE(saves_.find(input)->input_changed);
}

TEST_F(Autosave, ADamagedOneIsAnErrorThatNamesIt) {
  const std::string input = quickScenario(folder_);
  saves_.keep(input, {});
  writeFile(autosaveFileOf(input), "{\"schema_version\": 1, \"time_s\": ");
  EXPECT_THAT(errorOf([&] { saves_.find(input); }), HasSubstr(autosaveFileOf(input).string() + ":1:"));
}

/// A program that autosaves a view and is killed on request, without cleaning up.
class OtherProgram {
 public:
  OtherProgram(const std::string& input, const ViewState& state) {
    int to_child[2], to_parent[2];
    if (pipe(to_child) != 0 || pipe(to_parent) != 0) return;
    process_ = fork();
    char sign = 0;
    if (process_ == 0) {
      Autosaves saves;
      saves.keep(input, state);
      close(to_child[1]);
      const bool has_told = ::write(to_parent[1], "k", 1) == 1;
      _exit(has_told && ::read(to_child[0], &sign, 1) >= 0 ? 0 : 1);
    }
    close(to_child[0]);
    end_ = to_child[1];
    EXPECT_EQ(::read(to_parent[0], &sign, 1), 1);
    close(to_parent[0]);
    close(to_parent[1]);
  }
  ~OtherProgram() { end(); }

  void end() {
    if (process_ <= 0) return;
    close(end_);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  pid_t process_ = -1;
  int end_ = -1;
};

TEST_F(Autosave, IsNotOfferedWhileItsProgramRuns) {
  const std::string input = quickScenario(folder_);
  ViewState state;
  state.time_s = 3;
  OtherProgram other(input, state);
  EXPECT_FALSE(saves_.find(input));
  other.end();
  const std::optional<AutosavedView> found = saves_.find(input);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->state.time_s, 3);
  Autosaves third;
  EXPECT_FALSE(third.find(input));  // taken by the one that found it
}

TEST_F(Autosave, ProgramsThatRunAtTheSameTimeHaveOneEach) {
  const std::string input = quickScenario(folder_);
  ViewState state;
  state.time_s = 3;
  OtherProgram other(input, state);
  state.time_s = 4;
  saves_.keep(input, state);
  EXPECT_EQ(saves_.find(input)->file, autosaveFileOf(input, 2));
  EXPECT_EQ(saves_.find(input)->state.time_s, 4);
  other.end();
  EXPECT_EQ(saves_.find(input)->others, 1);
  saves_.discard(input);
  EXPECT_EQ(saves_.find(input)->state.time_s, 3);
  saves_.discard(input);
  EXPECT_TRUE(fs::is_empty(stateFolder() / "autosave"));
}

TEST_F(Autosave, IsNotReplacedByAProgramThatWasNotOfferedIt) {
  const std::string input = quickScenario(folder_);
  ViewState state;
  state.time_s = 3;
  OtherProgram(input, state).end();
  saves_.keep(input, {});
  EXPECT_EQ(saves_.find(input)->file, autosaveFileOf(input, 2));
  Autosaves next;
  EXPECT_EQ(next.find(input)->state.time_s, 3);
}

TEST_F(Autosave, WhatWasFoundIsNotReplacedUntilItIsAdoptedOrDiscarded) {
  const std::string input = quickScenario(folder_);
  ViewState state;
  state.time_s = 3;
  OtherProgram(input, state).end();
  ASSERT_TRUE(saves_.find(input));
  state.time_s = 4;
  saves_.keep(input, state);
  EXPECT_EQ(readViewState(autosaveFileOf(input).string()).time_s, 3);
  EXPECT_EQ(readViewState(autosaveFileOf(input, 2).string()).time_s, 4);
  saves_.remove(input);  // a regular end
  EXPECT_EQ(saves_.find(input)->state.time_s, 3);
  saves_.adopt(input);
  saves_.keep(input, state);
  EXPECT_EQ(readViewState(autosaveFileOf(input).string()).time_s, 4);
  EXPECT_FALSE(fs::exists(autosaveFileOf(input, 2)));
}

TEST_F(Autosave, WhatWasStoredStaysWhereWhatWasFoundIsAdopted) {
  const std::string input = quickScenario(folder_);
  ViewState state;
  state.time_s = 3;
  OtherProgram(input, state).end();
  ASSERT_TRUE(saves_.find(input));
  for (const double time_s : {4.0, 5.0}) {
    state.time_s = time_s;
    saves_.keep(input, state);
    saves_.adopt(input);
  }
  saves_.keep(input, {});
  EXPECT_EQ(readViewState(autosaveFileOf(input).string()).time_s, 5);
}

TEST_F(Autosave, AFileThatCannotBeLockedIsAnErrorAndNotAnotherProgram) {
  const std::string input = quickScenario(folder_);
  OtherProgram(input, {}).end();
  const fs::path lock = autosaveFileOf(input).string() + ".lock";
  fs::remove(lock);
  fs::create_directory(lock);
  EXPECT_THAT(errorOf([&] { saves_.find(input); }), HasSubstr(lock.string()));
  EXPECT_TRUE(fs::exists(autosaveFileOf(input)));
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
