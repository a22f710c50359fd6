/// The view of a session as a file: it draws the picture that the window shows.
#include <fmt/format.h>

#include <random>

#include "base/text/shell_word.h"
#include "emscape/render/picture/image.h"
#include "playback/editing/edit_history.h"
#include "playback/pictures/picture_series.h"
#include "playback/view/view_file.h"
#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

using testing::HasSubstr;

/// What `emscape render INPUT --state` draws.
struct Rendered {
  render::Image8 volume;   ///< bare
  render::Image8 picture;  ///< with background and labels
};

Rendered render(const std::string& input, const playback::ViewState& written,
                bool must_show_isosurface = true) {
  playback::ViewState view = playback::parseViewState(playback::viewStateText(written), "test.view.json");
  view.input = input;
  playback::FrameSelection selection(view);
  selection.times = fmt::format("{}", view.time_s);
  const auto source = playback::openFrameSource(selection, cpu());
  playback::Painter painter(view, *source, cpu(), must_show_isosurface);
  painter.setFrame(source->frame(0));
  painter.draw(render::FramePlan::exact());
  return {render::quantize(painter.image()), painter.picture(painter.note(render::Pattern::full))};
}

/// A view, and commands that change it by hand, both random.
class RandomView {
 public:
  RandomView(unsigned seed, double duration_s, std::vector<std::string> emitters)
      : random_(seed), duration_s_(duration_s), emitters_(std::move(emitters)) {}

  ViewOptions options(const std::string& input) {
    ViewOptions options = optionsFor(input, {between(120, 420), between(90, 320)});
    playback::ViewState& view = options.view;
    view.camera.azimuth_deg = number(0, 360);
    view.camera.elevation_deg = number(-20, 80);
    if (flip()) view.camera.distance = number(0.4, 2);
    if (flip()) view.camera.projection = render::Projection::orthographic;
    view.time_s = number(0, duration_s_);
    view.theme = flip() ? render::Theme::light : render::Theme::dark;
    view.settings.mode = static_cast<render::CompositingMode>(between(0, 3));
    view.settings.iso_value = number(-45, -35);
    view.settings.step_voxels = number(0.5, 2);
    view.settings.shading = flip();
    if (flip()) view.settings.planes.push_back(render::parseCutPlane("vertical:bearing_deg=70"));
    if (flip()) view.settings.planes.push_back(render::parseCutPlane("horizontal:altitude_m=2000"));
    view.show_terrain = flip();
    view.show_emitters = flip();
    view.graticule = flip() ? playback::Shown::on : playback::Shown::automatic;
    view.show_scale_bar = flip();
    view.show_compass = flip();
    if (flip()) view.range_rings.push_back({emitters_.front(), number(1000, 9000), between(0, 3)});
    view.units = flip() ? Units::nautical : Units::metric;
    view.field_unit = static_cast<FieldUnit>(between(0, 2));
    view.positions = static_cast<PositionFormat>(between(0, 2));
    if (flip()) view.range = volume::ValueRange{-110, static_cast<float>(number(-60, -10))};
    for (const std::string& emitter : emitters_) {
      if (flip())
        view.edits.push_back({"emitters." + emitter + ".power_w", fmt::format("{}", number(1, 1e5))});
    }
    return options;
  }
  std::string command() {
    switch (between(0, 6)) {
      case 0:
        return fmt::format(R"({{"do":"orbit","azimuth_deg":{},"elevation_deg":{}}})", number(-90, 90),
                           number(-20, 20));
      case 1:
        return fmt::format(R"({{"do":"dolly","factor":{}}})", number(0.5, 1.5));
      case 2:
        return fmt::format(R"({{"do":"pan","right_px":{},"down_px":{}}})", number(-60, 60), number(-60, 60));
      case 3:
        return fmt::format(R"({{"do":"transfer","colors":"{}"}})", flip() ? "inferno" : "cividis");
      case 4:
        return fmt::format(R"({{"do":"opacity","factor":{}}})", number(0.3, 3));
      case 5:
        return fmt::format(R"({{"do":"range","min":{},"max":{}}})", number(-120, -90), number(-60, -20));
      default:
        return fmt::format(R"({{"do":"seek","time_s":{}}})", number(0, duration_s_));
    }
  }

 private:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int between(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool flip() { return between(0, 1) == 1; }

  std::mt19937 random_;
  const double duration_s_;
  const std::vector<std::string> emitters_;
};

void expectThePictureOfRender(const std::string& input, RandomView& random) {
  SessionSample shown(random.options(input));
  ASSERT_TRUE(shown.settle());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(shown.perform(random.command()), "");
  ASSERT_TRUE(shown.settle());
  const playback::LivePicture& picture = *shown->picture();
  const Rendered rendered = render(input, shown->viewState());
  EXPECT_EQ(picture.size, rendered.volume.size);
  EXPECT_TRUE(picture.image.rgba == rendered.volume.rgba) << playback::viewStateText(shown->viewState());

  const StateFolder folder;
  const std::string file = folder / "picture.png";
  shown.perform(fmt::format(R"({{"do":"picture","file":"{}"}})", file));
  ASSERT_TRUE(shown.settle()) << shown->notice().text;
  const render::ImageDifference difference = render::compare(render::readPng(file), rendered.picture);
  EXPECT_EQ(difference.erroneous, 0);
}

TEST(SessionState, SLOW_RandomViewsEqualPicturesOfRender) {
  const StateFolder folder;
  for (unsigned seed = 1; seed <= 14; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    RandomView random(seed, 4, {"radar", "transmitter"});
    expectThePictureOfRender(shippedScenario("quick.yaml"), random);
  }
}

TEST(SessionState, SLOW_RandomViewsOfRealGroundEqualPicturesOfRender) {
  const StateFolder folder;
  for (unsigned seed = 15; seed <= 20; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    RandomView random(seed, 120, {"jammer", "search radar"});
    expectThePictureOfRender(shippedScenario("jacksboro.yaml"), random);
  }
}

TEST(SessionState, IsSavedAndShownAgain) {
  const StateFolder folder;
  SessionSample shown(optionsFor(shippedScenario("quick.yaml")));
  ASSERT_TRUE(shown.settle());
  shown.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  shown.perform(R"({"do":"seek","time_s":2})");
  shown.perform(R"({"do":"bookmark","number":3})");
  shown.perform(R"({"do":"rate","value":5})");
  shown.perform(R"({"do":"loop"})");
  shown.perform(R"({"do":"play_from","time_s":1})");
  shown.perform(R"({"do":"timeline","from_s":0.5,"to_s":3})");
  shown.perform(R"({"do":"opacity","factor":2})");
  shown.perform(R"({"do":"panel","name":"colors","open":true})");
  ASSERT_TRUE(shown.settle());
  const std::string file = folder / "a.view.json";
  shown.perform(fmt::format(R"({{"do":"save_state","file":"{}"}})", file));
  ASSERT_TRUE(shown.settle());

  ViewOptions options = optionsFor(shippedScenario("quick.yaml"));
  options.view = playback::readViewState(file);
  options.view.input = shippedScenario("quick.yaml");
  options.state = file;
  SessionSample again(options);
  ASSERT_TRUE(again.settle());
  EXPECT_EQ(playback::viewStateText(again->viewState()), readFile(file));
  EXPECT_TRUE(again->picture()->image.rgba == shown->picture()->image.rgba);
  EXPECT_TRUE(again->panels.colors);
  EXPECT_TRUE(again->timeline().loop());
  EXPECT_EQ(again->timeline().playRange().begin_s, 1);
  EXPECT_EQ(again->timeline().playRange().end_s, shown->timeline().end_s());
  EXPECT_EQ(again->timeline().visible().begin_s, 0.5);
  EXPECT_EQ(again->timeline().visible().end_s, 3);
}

TEST(SessionState, IsosurfaceOutsideOfTheValuesIsNotDrawn) {
  const StateFolder folder;
  ViewOptions options = optionsFor(shippedScenario("quick.yaml"));
  options.view.settings.mode = render::CompositingMode::iso;
  options.view.settings.iso_value = 999;
  SessionSample shown(options);
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown.error(), "");
  EXPECT_EQ(shown->status().error, "");
  EXPECT_TRUE(shown->picture()->image.rgba ==
              render(options.view.input, shown->viewState(), false).volume.rgba);
}

TEST(SessionState, AnotherQuantityIsShownInColoursOfItsOwn) {
  const StateFolder folder;
  ViewOptions options = optionsFor(shippedScenario("quick.yaml"));
  {
    SessionSample shown(options);
    ASSERT_TRUE(shown.settle());
    options.view = shown->viewState();
  }
  ASSERT_TRUE(options.view.transfer);
  SessionSample shown(options);
  ASSERT_TRUE(shown.settle());
  shown.perform(R"({"do":"quantity","name":"snr_db"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(shown.error(), "");
  EXPECT_EQ(shown->picture()->transfer.unit, "dB");
}

TEST(SessionState, WritesFilesOnlyUnderNamesOfTheirKind) {
  const StateFolder folder;
  SessionSample shown(optionsFor(shippedScenario("quick.yaml")));
  ASSERT_TRUE(shown.settle());
  const auto fault = [&](const std::string& verb, const std::string& name) {
    return shown.perform(fmt::format(R"({{"do":"{}","file":"{}"}})", verb, name));
  };
  EXPECT_EQ(fault("picture", "p.jpg"), "p.jpg: must end in .png");
  EXPECT_EQ(fault("screenshot", "s"), "s: must end in .png");
  EXPECT_EQ(fault("save", "s.vdb"), "s.vdb: must end in .yaml or .yml or .json");
  EXPECT_EQ(fault("save_transfer", "t.png"), "t.png: must end in .json");
  EXPECT_EQ(fault("save_state", "a.txt"), "a.txt: must end in .json");
  ASSERT_TRUE(shown.settle());
  for (const char* name : {"p.jpg", "s", "s.vdb", "t.png", "a.txt"})
    EXPECT_FALSE(std::filesystem::exists(name));
}

TEST(SessionState, WriteFailureOfViewIsReported) {
  const StateFolder folder;
  SessionSample shown(optionsFor(shippedScenario("quick.yaml")));
  ASSERT_TRUE(shown.settle());
  shown.perform(R"({"do":"save_state","file":"/no/such/folder/a.view.json"})");
  ASSERT_TRUE(shown.settle());
  EXPECT_TRUE(shown->notice().is_error);
  EXPECT_THAT(shown->notice().text, HasSubstr("/no/such/folder/a.view.json"));
}

TEST(SessionState, TheCopiedCommandNamesTheSavedViewUntilItChanges) {
  const StateFolder folder;
  SessionSample shown(optionsFor(shippedScenario("quick.yaml")));
  ASSERT_TRUE(shown.settle());
  const auto copied = [&shown] {
    shown.perform(R"({"do":"copy_command"})");
    EXPECT_TRUE(shown.settle());
    return shown.window.clipboard;
  };
  EXPECT_THAT(copied(), testing::AllOf(HasSubstr("--camera orbit:"), testing::Not(HasSubstr("--transfer"))));
  const std::string file = folder / "a.view.json";
  shown.perform(fmt::format(R"({{"do":"save_state","file":"{}"}})", file));
  ASSERT_TRUE(shown.settle());
  EXPECT_EQ(copied(), "emscape render " + shellWord(shippedScenario("quick.yaml")) + " --state " + file +
                          " -o picture.png");
  shown.perform(R"({"do":"set","path":"emitters.radar.power_w","value":"500"})");
  shown.perform(R"({"do":"opacity","factor":2})");
  ASSERT_TRUE(shown.settle());
  EXPECT_THAT(copied(), testing::AllOf(HasSubstr("--set emitters.radar.power_w=500"),
                                       HasSubstr("--transfer "), testing::Not(HasSubstr("--state"))));
}

}  // namespace
}  // namespace emscape::view::test
