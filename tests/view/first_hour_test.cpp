/// The walk "The first hour" of docs/viewer.md, with keys and mouse.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "emscape/render/picture/image.h"
#include "tests/support/files.h"
#include "tests/view/real_input.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// In a window of 1200 x 900 pixels
constexpr int kMenuBar_px = 24;
constexpr Place kValley{300, 380}, kFirstEmitterOfProbe{960, 380}, kHeightOfMast{1093, 327},
    kEmptyPicture{250, 150}, kFarGround{560, 420}, kFileOfRecord{500, 291}, kStepOfRecord{395, 462};
// From the thing whose menu it is
constexpr Place kFirstEntry{45, 46}, kSelectPlatform{84, 258};

Place operator+(const Place& a, const Place& b) {
  return {a.x + b.x, a.y + b.y};
}

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
    for (int n = 0; n < 20 && last("frame")["selected"] != path; ++n) {
      const Json before = last("frame")["selected"];
      EXPECT_TRUE(xdotool("key y"));
      EXPECT_TRUE(reports("selected", [&](const Json& now) { return now != before; }));
    }
    const Json frame = last("frame");
    EXPECT_EQ(frame["selected"], path);
    return {static_cast<int>(frame["selected_x"].get<double>()),
            static_cast<int>(frame["selected_y"].get<double>()) + kMenuBar_px};
  }
  /// Opens a file by its typed path.
  void openTyped(const std::string& file) {
    ASSERT_TRUE(xdotool("key ctrl+o sleep 0.5" + type(file) + " key Return"));
    ASSERT_TRUE(reports("input", file));
    ASSERT_TRUE(reports("program", "IDLE"));
  }
  /// Waits until the picture shows all, and writes the window. @return its picture
  render::Image8 look(const char* step) {
    SCOPED_TRACE(step);
    EXPECT_TRUE(reports("program", "IDLE")) << step;
    const std::size_t before = log("notice").size();
    EXPECT_TRUE(xdotool("key F12"));
    EXPECT_TRUE(comes([&] { return log("notice").size() > before; })) << step;
    const std::string text = last("notice")["text"];
    EXPECT_THAT(text, HasSubstr("written: ")) << step;
    const std::string file = text.substr(text.find('/'));
    if (const char* folder = std::getenv("EMSCAPE_WALK_PICTURES"))
      fs::copy_file(file, fs::path(folder) / (std::string(step) + ".png"),
                    fs::copy_options::overwrite_existing);
    EXPECT_EQ(log("error").size(), 0U) << step << ": " << Json(log("error")).dump();
    return render::readPng(file);
  }
};

TEST_F(FirstHour, SLOW_IsAsTheDocumentationSays) {
  forgetLog();
  program_ = std::make_unique<RunningProgram>(
      Arguments{"view", "--size", "1200x900", "--backend", "cpu", "--log", logFile()}, environment());
  ASSERT_TRUE(comesToLog("frame"));
  activate();
  openTyped(input("jacksboro.yaml"));
  activate();  // the title is another one
  look("open");

  ASSERT_TRUE(xdotool("key space"));
  EXPECT_TRUE(reports("shown_s", [](const Json& time_s) { return time_s > 0.5; }));
  EXPECT_EQ(last("frame")["program"], "PLAYING");
  ASSERT_TRUE(xdotool("key space"));
  look("play");

  ASSERT_TRUE(xdotool("key g sleep 0.3" + type("90") + " key Return"));
  EXPECT_TRUE(reports("shown_s", 90));
  look("seek");

  ASSERT_TRUE(xdotool(at(kValley) + " sleep 0.5 key p"));
  EXPECT_TRUE(reports("probe_locked", true));
  const render::Image8 closed = look("probe");

  ASSERT_TRUE(xdotool(click(kFirstEmitterOfProbe)));
  constexpr int kChangedPixels = 20000;  // of the verdict, the profile and the budget
  EXPECT_GT(render::compare(closed, look("why")).erroneous, kChangedPixels);

  const Place mast = select("emitters.communications mast");
  ASSERT_TRUE(xdotool(at(mast) + " click 3 sleep 0.7" + at(mast + kSelectPlatform) + " sleep 0.5 click 1"));
  EXPECT_TRUE(reports("selected", "platforms.mast"));
  ASSERT_TRUE(
      xdotool("sleep 0.5" + doubleClick(kHeightOfMast) + " sleep 0.5" + type("80 m") + " key Return"));
  ASSERT_TRUE(comesToLog("edit"));
  EXPECT_EQ(last("edit")["path"], "platforms.mast.position.height_agl_m");
  EXPECT_EQ(last("edit")["value"], "80");
  look("mast");

  ASSERT_TRUE(xdotool("key Escape"));  // the keys are for the picture again
  const Place radar = select("emitters.tracking radar");
  ASSERT_TRUE(xdotool(at(radar) + " mousedown 1" + at(radar + Place{-30, -10}) + " sleep 0.2" +
                      at(radar + Place{-87, -26}) + " sleep 0.5 mouseup 1"));
  EXPECT_TRUE(comes([&] { return last("edit")["path"] == "platforms.valley site.position.longitude_deg"; }));
  look("drag");

  const Place jammer = select("emitters.jammer");
  ASSERT_TRUE(xdotool(at(jammer) + " click 3 sleep 0.7" + at(jammer + kFirstEntry) + " sleep 0.5 click 1"));
  EXPECT_TRUE(comes([&] { return last("edit")["path"] == "emitters.jammer.enabled"; }));
  look("jammer");

  ASSERT_TRUE(xdotool(click(kEmptyPicture) + " key c"));
  EXPECT_TRUE(reports("compare", true));
  look("compare");
  ASSERT_TRUE(xdotool("key c"));

  ASSERT_TRUE(xdotool("key h"));
  EXPECT_TRUE(reports("planes", 1));
  look("plane");
  ASSERT_TRUE(xdotool("key h"));

  const Place search = select("emitters.search radar");
  ASSERT_TRUE(xdotool("key shift+m" + click(search) + " sleep 0.3" + click(kFarGround)));
  EXPECT_TRUE(reports("measured_m", [](const Json& value) { return value.is_number() && value > 1000; }));
  look("measure");
  ASSERT_TRUE(xdotool("key Escape"));

  const Json before = last("frame")["distance"];
  ASSERT_TRUE(xdotool("key ctrl+g sleep 0.5" + type("36.30, -84.20") + " key Return"));
  EXPECT_TRUE(reports("distance", [&](const Json& distance) { return distance != before; }));
  look("position");
  ASSERT_TRUE(xdotool("key r"));

  ASSERT_TRUE(xdotool("key ctrl+m sleep 0.7" + click(kFileOfRecord) + " key ctrl+a" +
                      type(input("film.mp4")) + doubleClick(kStepOfRecord) + " key ctrl+a" + type("60") +
                      " key Tab sleep 0.3 key Return"));
  EXPECT_TRUE(reports("recording", true));
  EXPECT_TRUE(reports("recording", false));
  EXPECT_TRUE(fs::exists(input("film.mp4")));

  ASSERT_TRUE(xdotool("key ctrl+s sleep 0.3 key ctrl+shift+v"));
  EXPECT_TRUE(comes([&] { return fs::exists(input("jacksboro.view.json")); }));
  EXPECT_TRUE(reports("unsaved", false));
  openTyped(input("jacksboro.edited.yaml"));
  EXPECT_EQ(last("frame")["edits"], 0);
  EXPECT_THAT(readFile(input("jacksboro.edited.yaml")), HasSubstr("height_agl_m: 80"));
  look("reopen");
}

}  // namespace
}  // namespace emscape::test
