/// The walk "The first hour" of docs/viewer.md, with keys and mouse.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "tests/support/files.h"
#include "tests/view/real_input.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// In a window of 1200 x 900 pixels
constexpr int kMenuBar_px = 24;
constexpr Place kValley{250, 420}, kBesideAll{60, 120};

class FirstHour : public RealInput {
 protected:
  void SetUp() override {
    RealInput::SetUp();
    if (IsSkipped()) return;
    fs::create_directories(input("data"));
    for (const char* name :
         {"jacksboro.yaml", "data/jacksboro.tif", "data/helicopter.csv", "data/sector_450mhz.msi"}) {
      fs::copy_file(shippedScenario(name), input(name));
    }
  }
  std::string input(const std::string& name) const { return folder_ / ("scenarios/" + name); }

  /// Selects an item with the key of the next one. @return where it is in the window
  Place select(const std::string& path) {
    for (int n = 0; n < 20 && log("frame").back()["selected"] != path; ++n) {
      const Json before = log("frame").back()["selected"];
      EXPECT_TRUE(xdotool("key y"));
      EXPECT_TRUE(reports("selected", [&](const Json& now) { return now != before; }));
    }
    const Json frame = log("frame").back();
    EXPECT_EQ(frame["selected"], path);
    return {static_cast<int>(frame["selected_x"].get<double>()),
            static_cast<int>(frame["selected_y"].get<double>()) + kMenuBar_px};
  }
  /// Opens a file by its typed path.
  void openTyped(const std::string& file) {
    ASSERT_TRUE(xdotool("key ctrl+o sleep 0.5" + type(file) + " key Return"));
    ASSERT_TRUE(reports("input", file));
    ASSERT_TRUE(reports("settled", true));
  }
  /// Waits until the picture shows all, and writes the window.
  void look(const char* step) {
    SCOPED_TRACE(step);
    EXPECT_TRUE(reports("settled", true)) << step;
    const std::size_t before = log("notice").size();
    EXPECT_TRUE(xdotool("key F12"));
    EXPECT_TRUE(comes([&] { return log("notice").size() > before; })) << step;
    EXPECT_THAT(log("notice").back()["text"].get<std::string>(), HasSubstr("written: ")) << step;
    EXPECT_EQ(log("error").size(), 0U) << step << ": " << Json(log("error")).dump();
  }
};

TEST_F(FirstHour, SLOW_IsAsTheDocumentationSays) {
  fs::remove(logFile());
  program_ = std::make_unique<RunningProgram>(
      Arguments{"view", "--size", "1200x900", "--backend", "cpu", "--log", logFile()}, environment());
  ASSERT_TRUE(comesToLog("frame"));
  activate();
  openTyped(input("jacksboro.yaml"));
  activate();  // the title is another one
  look("open");

  ASSERT_TRUE(xdotool("key space"));
  EXPECT_TRUE(reports("shown_s", [](const Json& time_s) { return time_s > 0.5; }));
  EXPECT_EQ(log("frame").back()["program"], "PLAYING");
  ASSERT_TRUE(xdotool("key space"));
  look("play");

  ASSERT_TRUE(xdotool("key g sleep 0.3" + type("90") + " key Return"));
  EXPECT_TRUE(reports("shown_s", 90));
  look("seek");

  ASSERT_TRUE(xdotool(at(kValley) + " sleep 0.5 key p"));
  EXPECT_TRUE(reports("probe_locked", true));
  look("probe");

  const Place mast = select("emitters.communications mast");
  ASSERT_TRUE(xdotool(click(mast)));
  look("select");
}

}  // namespace
}  // namespace emscape::test
