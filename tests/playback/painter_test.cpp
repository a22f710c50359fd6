#include "emscape/playback/painter.h"

#include <algorithm>

#include "emscape/base/log.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

TEST(Painter, LabelsAreDrawnOverWhatWasCastAndCanBeDrawnByOthers) {
  MadeFrames source(seconds(2));
  PictureStyle style;
  style.size = {160, 120};
  style.colors_span_range = true;
  Painter painter(style, source, {});
  painter.setFrame(source.frame(1));
  painter.draw({});
  const render::Image cast = painter.image();
  const render::Image8 picture = painter.picture("note");
  EXPECT_EQ(painter.annotations().time, "t = 1 s");
  EXPECT_EQ(painter.annotations().title, "made");
  const render::Image8 composed =
      render::compose(cast, painter.camera(), painter.sceneBox(), painter.annotations(),
                      [&](const Vec3d& position_m) { return painter.isHidden(position_m); });
  EXPECT_TRUE(composed.rgba == picture.rgba);
  render::Image8 bare;
  painter.fetch(bare);
  EXPECT_TRUE(bare.rgba == render::quantize(cast).rgba);
}

TEST(Painter, ACameraThatCameBackGivesTheSamePicture) {
  MadeFrames source(seconds(2));
  PictureStyle style;
  style.size = {160, 120};
  style.colors_span_range = true;
  Painter painter(style, source, {});
  painter.setFrame(source.frame(1));
  painter.draw({});
  const render::Image before = painter.image();
  EXPECT_TRUE(std::any_of(before.pixels.begin(), before.pixels.end(),
                          [](const render::Rgba& pixel) { return pixel.a > 0; }));
  render::CameraSpec closer = style.camera;
  closer.elevation_deg += 20;
  painter.setCamera(closer);
  painter.draw({});
  EXPECT_GT(render::compare(render::quantize(painter.image()), render::quantize(before)).erroneous, 0);
  painter.setCamera(style.camera);
  painter.draw({});
  EXPECT_EQ(render::compare(render::quantize(painter.image()), render::quantize(before)).erroneous, 0);
}

TEST(Painter, AnIsosurfaceThatShowsNothingIsAnErrorOrAWarning) {
  MadeFrames source(seconds(2));
  PictureStyle style;
  style.size = {160, 120};
  style.settings.mode = render::CompositingMode::iso;
  style.settings.iso_value = 99;
  Painter strict(style, source, {});
  EXPECT_EQ(errorOf([&] { strict.setFrame(source.frame(1)); }), "iso value 99: made ranges from 0 to 2");
  std::vector<std::string> messages;
  setLogSink([&](LogLevel, const std::string& message) { messages.push_back(message); });
  style.must_show_isosurface = false;
  Painter painter(style, source, {});
  painter.setFrame(source.frame(1));
  painter.setFrame(source.frame(0));
  setLogSink({});
  EXPECT_THAT(messages, testing::ElementsAre("iso value 99: made ranges from 0 to 2; no surface is drawn"));
  EXPECT_TRUE(painter.draw({}).complete);
}

}  // namespace
}  // namespace emscape::playback::test
