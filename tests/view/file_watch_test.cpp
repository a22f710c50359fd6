#include "apps/view/files/file_watch.h"

#include <atomic>
#include <filesystem>
#include <thread>

#include "apps/view/session/session_opener.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kQuick_s = 0.01;

class WatchedFolder : public testing::Test {
 protected:
  WatchedFolder() { writeFile(file_, "a"); }

  /// The changes reported within a short time.
  std::vector<std::string> changes() {
    for (int i = 0; i < 1000 && wakes_ == told_; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    told_ = wakes_;
    return watch_.takeChanged();
  }
  /// The changes after several polls.
  std::vector<std::string> changesSoon() {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return watch_.takeChanged();
  }

  const StateFolder folder_;
  const std::string file_ = folder_ / "a.yaml";
  std::atomic<int> wakes_{0};
  int told_ = 0;
  FileWatch watch_{[this] { ++wakes_; }, kQuick_s};
};

TEST_F(WatchedFolder, ChangeIsReportedOnce) {
  watch_.watch({file_});
  EXPECT_THAT(changesSoon(), IsEmpty());
  writeFile(file_, "longer");
  EXPECT_THAT(changes(), ElementsAre(file_));
  EXPECT_THAT(changesSoon(), IsEmpty());
  EXPECT_EQ(wakes_, 1);
  writeFile(file_, "longer still");
  EXPECT_THAT(changes(), ElementsAre(file_));
}

TEST_F(WatchedFolder, AFileThatIsReplacedHasChanged) {
  watch_.watch({file_});
  writeFile(folder_ / "b", "b");
  fs::last_write_time(folder_ / "b", fs::last_write_time(file_));
  fs::rename(folder_ / "b", file_);
  EXPECT_THAT(changes(), ElementsAre(file_));
}

TEST_F(WatchedFolder, RemovedFileIsReportedWhenItReturns) {
  watch_.watch({file_});
  fs::remove(file_);
  EXPECT_THAT(changesSoon(), IsEmpty());
  writeFile(file_, "back");
  EXPECT_THAT(changes(), ElementsAre(file_));
}

TEST_F(WatchedFolder, OtherFilesAreIgnored) {
  writeFile(folder_ / "b.yaml", "b");
  watch_.watch({file_});
  writeFile(folder_ / "b.yaml", "longer");
  EXPECT_THAT(changesSoon(), IsEmpty());
  watch_.watch({file_, folder_ / "b.yaml"});
  EXPECT_THAT(changesSoon(), IsEmpty());
  writeFile(folder_ / "b.yaml", "longer still");
  EXPECT_THAT(changes(), ElementsAre(folder_ / "b.yaml"));
  watch_.watch({});
  writeFile(file_, "not asked for");
  EXPECT_THAT(changesSoon(), IsEmpty());
}

TEST(ChangedFiles, SLOW_AreOfferedForReloadingWithTheEditsThatApply) {
  const StateFolder folder;
  const std::string file = folder / "own.yaml";
  const std::string text = readFile(shippedScenario("quick.yaml"));
  writeFile(file, text);
  SessionSample shown(optionsFor(file));
  SessionOpener opener(shown.files, [&shown](const ViewOptions& options) { return shown.make(options); });
  ASSERT_TRUE(shown.settle());
  shown.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  EXPECT_FALSE(shown->panels.changed);
  writeFile(file, "# another comment\n" + text);
  ASSERT_TRUE(shown.waitUntil([&] { return shown->panels.changed; }));
  EXPECT_THAT(shown->changedFiles(), ElementsAre(file));
  shown.perform(R"({"do":"reload"})");
  for (int i = 0; i < 12000 && (opener.update(shown.session), opener.active()); ++i) {
    shown->update();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_TRUE(shown.settle());
  EXPECT_FALSE(shown->panels.changed);
  EXPECT_THAT(shown->changedFiles(), IsEmpty());
  EXPECT_EQ(shown->viewState().edits.size(), 1U);
}

TEST(ChangedFiles, TracksAndElevationFilesCount) {
  const auto scenario = scenario::loadScenario(shippedScenario("jacksboro.yaml"));
  EXPECT_THAT(scenario::filesOf(*scenario),
              testing::IsSupersetOf({shippedScenario("jacksboro.yaml"), shippedScenario("data/jacksboro.tif"),
                                     shippedScenario("data/helicopter.csv")}));
}

}  // namespace
}  // namespace emscape::view::test
