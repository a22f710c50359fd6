#include "emscape/playback/pictures/painter.h"

#include <algorithm>

#include "emscape/base/log.h"
#include "emscape/volume/format/file.h"
#include "playback/pictures/picture_sink.h"
#include "tests/playback/playback_samples.h"
#include "volume/labels.h"

namespace emscape::playback::test {
namespace {

TEST(Painter, LabelsAreDrawnOverTheCastPictureOrByTheCaller) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {160, 120};
  view.range = ValueRange{0, 2};
  Painter painter(view, source, {});
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

TEST(Painter, PartsOfASplitPictureAreThoseOfTheTwoFields) {
  const TemporaryFolder folder;
  ViewState view;
  view.input = quickScenario(folder);
  view.size = {160, 120};
  view.range = ValueRange{-90, -30};
  const auto castOf = [&](double split, const std::vector<scenario::Edit>& edits) {
    ViewState shown = view;
    shown.edits = edits;
    changeSplit(shown, split);
    const auto source = openFrameSource(FrameSelection(shown), {});
    Painter painter(shown, *source, {});
    painter.setFrame(source->frame(1));
    EXPECT_EQ(painter.splitColumn(), static_cast<int>(split * 160));
    painter.draw({});
    return render::quantize(painter.image());
  };
  const std::vector<scenario::Edit> edits{{"emitters.radar.power_w", "1000000"}};
  const render::Image8 original = castOf(0, {}), changed = castOf(0, edits), split = castOf(0.35, edits);
  int differ = 0;
  for (std::size_t i = 0; i < split.rgba.size(); ++i) {
    const int column = static_cast<int>(i / 4 % 160);
    EXPECT_NEAR(split.rgba[i], (column < 56 ? original : changed).rgba[i], 1) << column;
    differ += original.rgba[i] != changed.rgba[i] ? 1 : 0;
  }
  EXPECT_GT(differ, 1000);
}

TEST(Painter, ReturningCameraGivesSamePicture) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {160, 120};
  view.range = ValueRange{0, 2};
  Painter painter(view, source, {});
  painter.setFrame(source.frame(1));
  painter.draw({});
  const render::Image before = painter.image();
  EXPECT_TRUE(std::any_of(before.pixels.begin(), before.pixels.end(),
                          [](const render::Rgba& pixel) { return pixel.a > 0; }));
  render::CameraSpec closer = view.camera;
  closer.elevation_deg += 20;
  painter.setCamera(closer);
  painter.draw({});
  EXPECT_GT(render::compare(render::quantize(painter.image()), render::quantize(before)).erroneous, 0);
  painter.setCamera(view.camera);
  painter.draw({});
  EXPECT_EQ(render::compare(render::quantize(painter.image()), render::quantize(before)).erroneous, 0);
}

TEST(Painter, AzimuthIsThatOfACameraWithIt) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {80, 60};
  Painter turned(view, source, {}), made(view, source, {});
  turned.setFrame(source.frame(1));
  made.setFrame(source.frame(1));
  turned.setAzimuth(view.camera.azimuth_deg + 70);
  render::CameraSpec camera = view.camera;
  camera.azimuth_deg += 70;
  made.setCamera(camera);
  turned.draw({});
  made.draw({});
  EXPECT_TRUE(render::quantize(turned.image()).rgba == render::quantize(made.image()).rgba);
}

TEST(Painter, FullCastEqualsRestoredPictureAndLeavesIt) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {80, 60};
  Painter painter(view, source, {});
  painter.setFrame(source.frame(1));
  painter.draw({render::Pattern::quarter, {}});
  const render::Image8 drawn = render::quantize(painter.image());
  painter.restore();
  const render::Image8 restored = render::quantize(painter.image());
  EXPECT_FALSE(restored.rgba == drawn.rgba);
  EXPECT_TRUE(render::quantize(painter.fullCast()).rgba == restored.rgba);
  EXPECT_TRUE(render::quantize(painter.image()).rgba == restored.rgba);
}

TEST(Painter, ColorsAreFittedToAFrameOrARange) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {80, 60};
  Painter painter(view, source, {});
  Frame frame = source.frame(1);
  painter.setFrame(frame);
  const render::TransferFunction fitted = painter.transferFunction();
  ViewState ranged;
  ranged.range = ValueRange{-3, 9};
  EXPECT_TRUE(painter.setColors(ranged));
  EXPECT_EQ(painter.transferFunction().lowest(), -3);
  EXPECT_EQ(painter.transferFunction().highest(), 9);
  EXPECT_FALSE(painter.setColors(ranged));
  EXPECT_TRUE(painter.setColors({}));
  EXPECT_EQ(painter.transferFunction().lowest(), fitted.lowest());
  EXPECT_EQ(painter.transferFunction().highest(), fitted.highest());
  view.range = ValueRange{-4, 6};
  Painter spanning(view, source, {});
  spanning.setFrame(frame);
  EXPECT_EQ(spanning.transferFunction().lowest(), -4);
  EXPECT_EQ(spanning.transferFunction().highest(), 6);
}

TEST(PictureSink, WritesOnePngOrANumberedFolder) {
  const TemporaryFolder folder;
  render::Image8 picture;
  picture.size = {4, 4};
  picture.rgba.assign(4 * 4 * 4, 255);
  const auto one = makePictureSink(folder / "one.png", "made", 1, picture.size, 10, "");
  one->add(1, picture, 1);
  one->finish();
  EXPECT_TRUE(std::filesystem::exists(folder / "one.png"));
  auto several = makePictureSink(folder / "frames", "a/b", 2, picture.size, 10, "");
  for (const int number : {1, 2}) several->add(number, picture, 1);
  EXPECT_THAT(errorOf([&] { makePictureSink(folder / "frames", "a/b", 2, picture.size, 10, ""); }),
              testing::HasSubstr("frames: another process writes this folder"));
  makePictureSink(folder / "frames", "other", 1, picture.size, 10, "");
  several->finish();
  several.reset();
  EXPECT_EQ(folder.files().size(), 3u) << "no lock";
  folder.write("frames/a_b_0002.png", "mine");
  EXPECT_THAT(errorOf([&] { makePictureSink(folder / "frames", "a/b", 2, picture.size, 10, ""); }),
              testing::HasSubstr("a_b_0002.png: is a file that emscape did not write"));
  makePictureSink(folder / "frames", "a/b", 2, picture.size, 10, "", Replaces::any)->add(2, picture, 1);
  EXPECT_NE(readFile(folder / "frames/a_b_0002.png"), "mine");
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/a_b_0001.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/a_b_0002.png"));
  EXPECT_THAT(errorOf([&] { makePictureSink(folder / "one.png", "made", 2, picture.size, 10, ""); }),
              testing::HasSubstr("one .png for 2 pictures"));
  EXPECT_THAT(errorOf([&] { makePictureSink(folder / "a.gif", "made", 1, picture.size, 10, ""); }),
              testing::HasSubstr("must end in .png or .mp4"));
}

TEST(Painter, LabelsOfEmittersAreNoneNamesOrAll) {
  MadeFrames source(seconds(1));
  Frame frame = source.frame(0);
  render::Marker& marker = frame.markers.emplace_back();
  marker.label = "radar";
  marker.detail = "radar 3 GHz";
  marker.height_m = 20;
  marker.beam = Vec3d{0, 1, 0};
  marker.ground_m = 0;
  frame.tracks.resize(1);
  ViewState view;
  view.size = {160, 120};
  Painter painter(view, source, {});
  painter.setFrame(frame);
  for (const Labels labels : {Labels::names, Labels::off, Labels::all}) {
    view.labels = labels;
    painter.setScenery(view);
    const std::vector<render::Marker>& markers = painter.annotations().markers;
    ASSERT_EQ(markers.size(), 1U) << "the symbol stays";
    EXPECT_EQ(markers[0].label, labels == Labels::off ? "" : "radar");
    EXPECT_EQ(markers[0].detail.empty(), labels != Labels::all);
    EXPECT_EQ(markers[0].height_m.has_value(), labels == Labels::all);
    EXPECT_TRUE(markers[0].beam);
    EXPECT_EQ(painter.annotations().tracks.size(), 1U);
  }
}

TEST(Painter, SidesAreFiltered) {
  MadeFrames source(seconds(1));
  Frame frame = source.frame(0);
  for (const render::Affiliation side : {render::Affiliation::none, render::Affiliation::friendly,
                                         render::Affiliation::hostile, render::Affiliation::unknown}) {
    frame.markers.emplace_back().side = side;
    frame.tracks.emplace_back().side = side;
  }
  ViewState view;
  view.size = {160, 120};
  Painter painter(view, source, {});
  painter.setFrame(frame);
  const auto shown = [&] {
    std::vector<bool> of_marker;
    for (const render::Marker& marker : painter.annotations().markers) of_marker.push_back(marker.is_shown);
    return of_marker;
  };
  EXPECT_THAT(shown(), testing::ElementsAre(true, true, true, true));
  view.sides = ShownSides::hostile;
  painter.setScenery(view);
  EXPECT_THAT(shown(), testing::ElementsAre(false, false, true, false));
  ASSERT_EQ(painter.annotations().tracks.size(), 1U);
  EXPECT_EQ(painter.annotations().tracks[0].side, render::Affiliation::hostile);
}

TEST(Painter, EmptyIsosurfaceIsAnErrorOrAWarning) {
  MadeFrames source(seconds(2));
  ViewState view;
  view.size = {160, 120};
  view.settings.mode = render::CompositingMode::iso;
  view.settings.iso_value = 99;
  Painter strict(view, source, {});
  EXPECT_EQ(errorOf([&] { strict.setFrame(source.frame(1)); }), "iso value 99: made ranges from 0 to 2");
  std::vector<std::string> messages;
  setLogSink([&](LogLevel, const std::string& message) { messages.push_back(message); });
  Painter painter(view, source, {}, /*must_show_isosurface=*/false);
  painter.setFrame(source.frame(1));
  painter.setFrame(source.frame(0));
  setLogSink({});
  EXPECT_THAT(messages, testing::ElementsAre("iso value 99: made ranges from 0 to 2; no surface is drawn"));
  EXPECT_TRUE(painter.draw({}).complete);
}

TEST(Painter, TheLegendOfIndicesHasTheNamesOfTheVolume) {
  const TemporaryFolder folder;
  volume::DenseVolume volume;
  volume.grid.dims = {2, 2, 1};
  volume.grid.spacing_m = {100, 100, 100};
  volume.grid.frame = {FrameKind::altitude, 52, 5, 0};
  volume.grid.georeferenced = true;
  volume.info.quantity = "dominant_emitter";
  volume.info.categorical = true;
  volume.info.floor = -1;
  volume.info.range_min = 1;
  volume.info.range_max = 2;
  volume.info.extra[volume::kLabelsKey] = "radar\njammer\nradio\nlink";
  volume.values = {-1, 1, 2, 2};
  const auto namesWith = [&](const std::string& scenario) {
    volume::writeVolumes(folder / "a.vdb", {&volume});
    FrameSelection selection;
    selection.input = folder / "a.vdb";
    selection.scenario = scenario;
    const auto source = openFrameSource(selection, {});
    ViewState view;
    view.size = {160, 120};
    Painter painter(view, *source, {});
    painter.setFrame(source->frame(0));
    std::string names;
    for (const render::Category& category : painter.annotations().legend->categories)
      names += std::to_string(category.index) + " " + category.name + ", ";
    return names;
  };
  EXPECT_EQ(namesWith(""), "1 jammer, 2 radio, ") << "those in the range";
  const std::string quick = quickScenario(folder);
  EXPECT_EQ(namesWith(quick), "1 jammer, 2 radio, ") << "a scenario with other emitters";
  volume.info.extra[volume::kLabelsKey] = "radar\ntransmitter";
  EXPECT_EQ(namesWith(quick), "0 radar, 1 transmitter, ") << "all that can occur in its scenario";
  volume.info.extra["scenario_hash"] = "0123";
  EXPECT_EQ(namesWith(quick), "1 transmitter, ") << "another scenario with the same names";
}

}  // namespace
}  // namespace emscape::playback::test
