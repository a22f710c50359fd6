/// Pictures against those of tests/data/pictures. To rewrite them, and inspect them before committing:
///     EMSCAPE_WRITE_PICTURES=1 build/release/bin/playback_tests --gtest_filter='*ReferencePicture*'
#include <cstdlib>
#include <ostream>

#include "emscape/playback/pictures/painter.h"
#include "emscape/render/picture/image.h"
#include "playback/view/view_file.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

struct Shot {
  const char* name;
  const char* view;  ///< keys of a view file besides size and the scenario's edits
  int width = 160, height = 120;
  bool labelled = false;  ///< with background, legend and labels; else the bare cast
};

void PrintTo(const Shot& shot, std::ostream* out) {
  *out << shot.name;
}

const Shot kShots[] = {
    {"camera", R"("camera": "orbit:azimuth_deg=215,elevation_deg=12,distance=0.9,projection=orthographic")"},
    {"ground", R"("camera": "orbit:azimuth_deg=120,elevation_deg=35,distance=0.8", "mode": "mip")"},
    {"shading",
     R"("camera": "orbit:azimuth_deg=150,elevation_deg=25,distance=0.8", "shading": true, "planes": ["vertical:bearing_deg=60,keep=left"])"},
    {"isosurface",
     R"("camera": "orbit:azimuth_deg=150,elevation_deg=25,distance=0.8", "mode": "iso", "iso_value": -40)"},
    {"legend", R"("theme": "light", "show_terrain": false)", 320, 240, true},
};

render::Image8 draw(const Shot& shot) {
  const std::string text = std::string(R"({"schema_version": 1, "time_s": 40, )") +
                           R"("range": {"min": -90, "max": -20}, "edits": ["region.dims=[40, 40, 20]"], )" +
                           "\"size\": [" + std::to_string(shot.width) + ", " + std::to_string(shot.height) +
                           "], " + shot.view + "}";
  ViewState view = parseViewState(text, "view.json");
  view.input = emscape::test::shippedScenario("jacksboro.yaml");
  FrameSelection selection(view);
  selection.times = "40";
  const auto source = openFrameSource(selection, {});
  Painter painter(view, *source, {});
  painter.setFrame(source->frame(0));
  painter.draw(render::FramePlan::exact());
  return shot.labelled ? painter.picture("note") : render::quantize(painter.image());
}

/// The largest difference of a pixel's channels (levels of 255). @param at  its first byte
int levelsApart(const render::Image8& a, const render::Image8& b, std::size_t at) {
  int largest = 0;
  for (std::size_t i = at; i < at + 4; ++i)
    largest = std::max(largest, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  return largest;
}

/// The differences, three times as large, in grey.
render::Image8 differenceOf(const render::Image8& a, const render::Image8& b) {
  render::Image8 difference = a;
  for (std::size_t pixel = 0; pixel < a.rgba.size(); pixel += 4) {
    const auto grey = static_cast<std::uint8_t>(std::min(3 * levelsApart(a, b, pixel), 255));
    for (std::size_t i = pixel; i < pixel + 3; ++i) difference.rgba[i] = grey;
    difference.rgba[pixel + 3] = 255;
  }
  return difference;
}

class ReferencePicture : public testing::TestWithParam<Shot> {};

TEST_P(ReferencePicture, IsDrawnAgain) {
  const std::string reference =
      emscape::test::sourceFile(std::string("tests/data/pictures/") + GetParam().name + ".png");
  const render::Image8 picture = draw(GetParam());
  if (std::getenv("EMSCAPE_WRITE_PICTURES")) return render::writePng(reference, picture);

  const render::Image8 expected = render::readPng(reference);
  const render::ImageDifference difference = render::compare(picture, expected);
  long long far_apart = 0;
  for (std::size_t pixel = 0; pixel < picture.rgba.size(); pixel += 4)
    far_apart += levelsApart(picture, expected, pixel) > 16 ? 1 : 0;
  // Tolerance for other fonts, and for rounding by other compilers.
  const double allowed = GetParam().labelled ? 0.02 : 0.002;
  EXPECT_LE(difference.mean_all, 0.5);
  EXPECT_LE(static_cast<double>(far_apart), allowed * static_cast<double>(picture.size.count()));
  if (HasFailure()) {
    TemporaryFolder folder;
    folder.keep();
    render::writePng(folder / "picture.png", picture);
    render::writePng(folder / "difference.png", differenceOf(picture, expected));
    ADD_FAILURE() << "see " << folder.path() << ": picture.png, difference.png; reference: " << reference;
  }
}

INSTANTIATE_TEST_SUITE_P(Shots, ReferencePicture, testing::ValuesIn(kShots),
                         [](const auto& shot) { return std::string(shot.param.name); });

}  // namespace
}  // namespace emscape::playback::test
