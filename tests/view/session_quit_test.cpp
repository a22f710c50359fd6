/// Questions before a loss: at the end, and before a file is replaced.
#include <fmt/format.h>

#include <filesystem>

#include "apps/view/files/picture_files.h"
#include "emscape/render/picture/image.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Loss : public testing::Test {
 protected:
  Loss()
      : shown_(optionsFor(folder_.write("own.yaml", readFile(shippedScenario("quick.yaml"))), {160, 120})) {
    shown_.settle();
  }
  void record() {
    shown_.perform(fmt::format(R"({{"do":"record","file":"{}","begin_s":0,"end_s":2,"step_s":0.25}})",
                               folder_ / "frames"));
  }
  bool waitUntilRecorded() {
    return shown_.waitUntil([this] { return !shown_.files->recorder.running(); });
  }

  StateFolder folder_;
  SessionSample shown_;
};

TEST_F(Loss, EditedColoursAreAskedForUntilTheyAreSaved) {
  EXPECT_FALSE(shown_->isUnsaved());
  shown_.perform(R"({"do":"transfer","colors":"inferno"})");
  EXPECT_TRUE(shown_->isUnsaved());
  shown_.perform(R"({"do":"quit"})");
  EXPECT_TRUE(shown_->panels.unsaved);
  EXPECT_FALSE(shown_.window.has_quit);
  shown_.perform(R"({"do":"quit","edits":"save"})");
  ASSERT_TRUE(shown_.waitUntil([this] { return shown_.window.has_quit; }));
  EXPECT_TRUE(fs::exists(folder_ / "own.transfer.json"));
}

TEST_F(Loss, ColoursOfASavedViewAreSaved) {
  shown_.perform(R"({"do":"transfer","colors":"inferno"})");
  shown_.perform(R"({"do":"save_state"})");
  ASSERT_TRUE(shown_.settle());
  EXPECT_FALSE(shown_->isUnsaved());
}

TEST_F(Loss, ARunningRecordingIsAskedForAndCanBeWaitedFor) {
  record();
  shown_.perform(R"({"do":"quit"})");
  EXPECT_TRUE(shown_->panels.unsaved);
  EXPECT_FALSE(shown_.window.has_quit);
  shown_.perform(R"({"do":"quit","recording":"wait"})");
  EXPECT_FALSE(shown_.window.has_quit);
  EXPECT_TRUE(shown_->quitsWhenRecorded());
  ASSERT_TRUE(shown_.waitUntil([this] { return shown_.window.has_quit; }));
  EXPECT_TRUE(fs::exists(folder_ / "frames/quick_0009.png"));
}

TEST_F(Loss, TheQuestionAboutARecordingStaysUntilItIsAnswered) {
  record();
  shown_.perform(R"({"do":"quit"})");
  ASSERT_TRUE(shown_.waitUntil([this] { return !shown_.files->recorder.running(); }));
  ASSERT_TRUE(shown_.settle());
  EXPECT_FALSE(shown_.window.has_quit);
  EXPECT_TRUE(shown_->panels.unsaved);
  shown_.perform(R"({"do":"quit","recording":"wait"})");
  EXPECT_TRUE(shown_.window.has_quit);
}

TEST_F(Loss, ASavedNameIsTheDocument) {
  const std::string input = shown_->document(), file = folder_ / "mine.yaml";
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  ASSERT_TRUE(shown_.settle());
  shown_.perform(Json{{"do", "save"}, {"file", file}}.dump());
  ASSERT_TRUE(shown_.settle());
  EXPECT_EQ(shown_->document(), file);
  EXPECT_EQ(shown_->usualScenarioFile(), file);
  EXPECT_EQ(shown_->files().recent.front(), file);
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"600"})");
  ASSERT_TRUE(shown_.settle());
  shown_.perform(R"({"do":"save"})");
  EXPECT_FALSE(shown_->panels.replace) << "this window has written it";
  ASSERT_TRUE(shown_.settle());
  EXPECT_THAT(readFile(file), HasSubstr("power_w: 600"));
  EXPECT_FALSE(shown_->hasUnsavedEdits());
}

TEST_F(Loss, ARecordingCanBeCancelledByTheEnd) {
  record();
  shown_.perform(R"({"do":"quit","recording":"cancel"})");
  EXPECT_TRUE(shown_.window.has_quit);
}

TEST_F(Loss, EditsAndARecordingAreBothAskedFor) {
  shown_.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  record();
  shown_.perform(R"({"do":"quit","recording":"wait"})");
  EXPECT_TRUE(shown_->panels.unsaved);
  shown_.perform(R"({"do":"quit","recording":"wait","edits":"discard"})");
  EXPECT_FALSE(shown_->panels.unsaved);
  EXPECT_TRUE(shown_->quitsWhenRecorded());
  ASSERT_TRUE(shown_.waitUntil([this] { return shown_.window.has_quit; }));
}

TEST_F(Loss, AnExistingFileIsReplacedOnlyAfterAnAnswer) {
  for (const char* verb : {"save", "save_state", "save_transfer", "picture"}) {
    const std::string ending = verb == std::string("save")      ? "yaml"
                               : verb == std::string("picture") ? "png"
                                                                : "json";
    const std::string file = folder_.write(fmt::format("{}.{}", verb, ending), "precious");
    shown_.perform(fmt::format(R"({{"do":"{}","file":"{}"}})", verb, file));
    EXPECT_TRUE(shown_->panels.replace) << verb;
    ASSERT_TRUE(shown_.settle());
    EXPECT_EQ(readFile(file), "precious") << verb;
    shown_.perform(R"({"do":"replace"})");
    ASSERT_TRUE(shown_.settle());
    EXPECT_FALSE(shown_->panels.replace) << verb;
    EXPECT_NE(readFile(file), "precious") << verb;
    shown_.perform(fmt::format(R"({{"do":"{}","file":"{}"}})", verb, file));
    EXPECT_FALSE(shown_->panels.replace) << verb << ": this window has written it";
    ASSERT_TRUE(shown_.settle());
    folder_.write(fmt::format("{}.{}", verb, ending), "precious again");
    fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
    shown_.perform(fmt::format(R"({{"do":"{}","file":"{}"}})", verb, file));
    EXPECT_TRUE(shown_->panels.replace) << verb << ": another program has written it since";
    shown_.perform(R"({"do":"back"})");
  }
}

TEST_F(Loss, ARecordingDoesNotReplaceAFilmWithoutAnAnswer) {
  const std::string file = folder_.write("film.mp4", "precious");
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}"}})", file));
  EXPECT_TRUE(shown_->panels.replace);
  EXPECT_FALSE(shown_.files->recorder.running());
}

TEST_F(Loss, ARecordingHasTheRequestedSize) {
  shown_.perform(fmt::format(R"({{"do":"record","file":"{}","begin_s":1,"end_s":1,"width":96,"height":54}})",
                             folder_ / "one.png"));
  ASSERT_TRUE(waitUntilRecorded());
  EXPECT_EQ(render::readPng(folder_ / "one.png").size, (render::ImageSize{96, 54}));
  EXPECT_THAT(shown_.perform(R"({"do":"record","file":"x.png","width":96})"), HasSubstr("width and height"));
}

TEST(PictureFiles, AreNewAndInTheFolderOfPicturesOrOfTheInput) {
  const TemporaryFolder home;
  const std::string old_home = getenv("HOME") ? getenv("HOME") : "";
  setenv("HOME", home.path().c_str(), 1);
  unsetenv("XDG_CONFIG_HOME");
  const std::string input = home / "input.yaml";
  std::set<std::string> given;
  EXPECT_EQ(newPictureFile(input, given), home / "emscape-0001.png");
  EXPECT_EQ(newPictureFile(input, given), home / "emscape-0002.png") << "given out, not yet written";
  fs::create_directories(home / "Pictures");
  home.write("Pictures/emscape-0001.png", "");
  EXPECT_EQ(newPictureFile(input, given), home / "Pictures/emscape-0002.png");
  fs::create_directories(home / "Bilder");
  fs::create_directories(home / ".config");
  home.write(".config/user-dirs.dirs", "# comment\nXDG_PICTURES_DIR=\"$HOME/Bilder\"\n");
  EXPECT_EQ(newPictureFile(input, given), home / "Bilder/emscape-0001.png");
  setenv("HOME", old_home.c_str(), 1);
}

TEST(Estimate, FollowsFromTimesRateAndSize) {
  const RecordEstimate film = estimateOf({{}, {}, {}, 10, {}}, 0, 120, 0.5, {1920, 1080}, 500, true);
  EXPECT_EQ(film.pictures, 241);
  EXPECT_DOUBLE_EQ(film.film_s, 24.1);
  EXPECT_DOUBLE_EQ(film.speed, 5);
  EXPECT_DOUBLE_EQ(film.work_s, 120.5);
  EXPECT_EQ(estimateOf({}, 0, 10, 0, {10, 10}, 1, true).pictures, 0);
  EXPECT_EQ(estimateOf({}, 5, 0, 1, {10, 10}, 1, true).pictures, 0);
}

// One picture of 241 took 8.8 s, the others 0.4 s.
TEST(Estimate, CountsNeitherTheFirstFieldNorAnOutlier) {
  FieldTimes times;
  times.add(0, 0);
  EXPECT_EQ(times.usual_ms(), 0);
  times.add(1, 8800);
  EXPECT_EQ(times.usual_ms(), 0) << "the first one reads the terrain";
  long long fields = 1;
  for (const double field_ms : {400.0, 8800.0, 430.0, 450.0}) times.add(++fields, field_ms);
  times.add(fields, 450);  // not another field
  EXPECT_EQ(times.usual_ms(), 430);
}

TEST(Warnings, AreThoseOfTheScenarioOnScreenAndGoWithTheEditThatCausesThem) {
  const StateFolder folder;
  SessionSample shown("quick.yaml");
  ASSERT_TRUE(shown.settle());
  const std::size_t before = shown->warnings().size();
  // More gain than the beam's directivity.
  EXPECT_EQ(shown.perform(R"({"do":"set","path":"emitters.radar.antenna.gain_dbi","value":"60"})"), "");
  EXPECT_TRUE(shown.waitUntil([&] { return shown->settled() && shown->warnings().size() > before; }));
  shown.perform(R"({"do":"undo"})");
  EXPECT_TRUE(shown.waitUntil([&] { return shown->settled() && shown->warnings().size() == before; }));
}

TEST(Warnings, OfADifferenceAreThoseOfTheFieldOnceAndGoWithTheDifference) {
  const StateFolder folder;
  SessionSample shown("quick.yaml", {{"emitters.radar.antenna.gain_dbi", "60"}});
  ASSERT_TRUE(shown.waitUntil([&] { return shown->settled() && !shown->warnings().empty(); }));
  const std::vector<std::string> before = shown->warnings();
  shown.perform(R"({"do":"compare"})");
  ASSERT_TRUE(shown.settle());
  shown.waitUntil([&] { return shown->warnings() == before; });
  EXPECT_EQ(shown->warnings(), before);
  shown.perform(R"({"do":"compare"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown->warnings(), before);
}

}  // namespace
}  // namespace emscape::view::test
