#include <random>

#include "emscape/playback/pictures/painter.h"
#include "playback/view/view_file.h"
#include "tests/playback/playback_samples.h"
#include "tests/support/working_folder.h"

namespace emscape::playback::test {
namespace {

using emscape::test::WorkingFolder;
using testing::HasSubstr;

class RandomState {
 public:
  explicit RandomState(unsigned seed) : random_(seed) {}

  ViewState make() {
    ViewState state;
    state.camera = camera();
    for (unsigned i = below(4); i > 0; --i) {
      state.bookmarks.push_back({text(), camera(), maybe(uniform(-10, 1e4))});
    }
    state.time_s = uniform(0, 1e5);
    state.rate = uniform(-120, 120);
    state.loop = coin();
    state.quantity = coin() ? "" : "snr_db:search \"radar\", 1";
    if (coin()) state.transfer = transfer();
    if (coin()) {
      state.range =
          volume::ValueRange{static_cast<float>(uniform(-200, 0)), static_cast<float>(uniform(0.1, 9))};
    }
    state.settings.mode = static_cast<render::CompositingMode>(below(4));
    state.settings.step_voxels = uniform(0.05, 10);
    state.settings.mida_gamma = uniform(-1, 1);
    state.settings.exact = coin();
    state.settings.shading = coin();
    if (coin()) state.settings.iso_value = uniform(-200, 10);
    state.settings.iso_opacity = uniform(0, 1);
    state.settings.vertical_exaggeration = coin() ? 0 : uniform(0.1, 20);
    for (unsigned i = below(4); i > 0; --i) state.settings.planes.push_back(plane());
    state.theme = coin() ? render::Theme::dark : render::Theme::light;
    state.show_terrain = coin();
    state.show_emitters = coin();
    state.coast = coin() ? Shown::automatic : Shown::off;
    state.graticule = coin() ? Shown::on : Shown::off;
    state.show_compass = coin();
    state.show_scale_bar = coin();
    for (unsigned i = below(3); i > 0; --i)
      state.range_rings.push_back(
          {"radar " + std::to_string(i), uniform(1, 1e5), static_cast<int>(below(4))});
    state.units = coin() ? Units::metric : Units::nautical;
    state.field_unit = static_cast<FieldUnit>(below(3));
    state.positions = static_cast<PositionFormat>(below(3));
    state.size = {static_cast<int>(1 + below(4000)), static_cast<int>(1 + below(4000))};
    for (unsigned i = below(4); i > 0; --i) state.edits.push_back({"emitters.\"a=b\".power_w", text()});
    if (coin()) state.compare = kOriginal;
    for (unsigned i = below(3); i > 0; --i) state.open_panels.push_back("panel " + std::to_string(i));
    if (coin()) state.play_range = interval();
    if (coin()) state.visible_time = interval();
    return state;
  }

 private:
  unsigned below(unsigned count) { return static_cast<unsigned>(random_()) % count; }
  bool coin() { return below(2) == 0; }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  std::optional<double> maybe(double value) { return coin() ? std::optional<double>(value) : std::nullopt; }
  scenario::TimeInterval interval() {
    const double begin_s = uniform(-10, 100);
    return {begin_s, begin_s + uniform(1e-3, 1000)};
  }
  std::string text() {
    static const char* const kTexts[] = {
        "ridge", "",   "a: b # c", "\"quoted\" \\ text", "two\nlines\t", "\xC3\xA9\xE2\x82\xAC", "[1, 2]",
        "true",  "12", "null"};
    return kTexts[below(std::size(kTexts))];
  }
  render::CutPlane plane() {
    render::CutPlane plane;
    plane.on = coin();
    plane.altitude_m = uniform(-100, 1e4);
    if (coin()) return coin() ? plane : render::flipped(plane);
    plane = {};
    plane.kind = render::CutPlane::Kind::vertical;
    plane.keep = coin() ? render::CutPlane::Side::left : render::CutPlane::Side::right;
    plane.bearing_deg = uniform(-360, 360);
    plane.offset_m = coin() ? 0 : uniform(-1e4, 1e4);
    if (coin()) {
      plane.x_m = uniform(-1e4, 1e4);
      plane.y_m = uniform(-1e4, 1e4);
    }
    return plane;
  }
  Vec3d position() { return {uniform(-1e5, 1e5), uniform(-1e5, 1e5), uniform(-1e3, 2e4)}; }
  render::CameraSpec camera() {
    render::CameraSpec camera;
    camera.fov_deg = uniform(1, 150);
    if (coin()) camera.projection = render::Projection::orthographic;
    if (coin()) {
      camera.kind = render::CameraSpec::Kind::lookat;
      camera.eye_m = position();
      camera.target_m = position();
      return camera;
    }
    camera.azimuth_deg = uniform(-360, 360);
    camera.elevation_deg = uniform(-90, 90);
    camera.distance = maybe(uniform(0.01, 10));
    if (coin()) camera.target_m = position();
    return camera;
  }
  render::TransferFunction transfer() {
    render::TransferFunction function;
    function.name = text();
    function.unit = "dB";
    for (int i = 0; i < 5; ++i) {
      function.colors.push_back({i + uniform(0, 0.5), {static_cast<float>(uniform(0, 1)), 0.5F, 1}});
      function.opacities.push_back({i + uniform(0, 0.5), uniform(0, 1)});
    }
    return function;
  }

  std::mt19937 random_;
};

TEST(ViewState, RandomStatesAreReadBackToTheBit) {
  RandomState random(3);
  for (int i = 0; i < 300; ++i) {
    const ViewState state = random.make();
    const std::string text = viewStateText(state);
    const ViewState read = parseViewState(text, "a.view.json");
    ASSERT_EQ(viewStateText(read), text);
    // The text has all digits, but that of a member could be left out.
    ASSERT_EQ(toString(read.camera), toString(state.camera));
    ASSERT_EQ(read.bookmarks.size(), state.bookmarks.size());
    for (std::size_t b = 0; b < read.bookmarks.size(); ++b) {
      ASSERT_EQ(read.bookmarks[b].name, state.bookmarks[b].name);
      ASSERT_EQ(read.bookmarks[b].time_s, state.bookmarks[b].time_s);
      ASSERT_EQ(toString(read.bookmarks[b].camera), toString(state.bookmarks[b].camera));
    }
    ASSERT_EQ(read.time_s, state.time_s);
    ASSERT_EQ(read.rate, state.rate);
    ASSERT_EQ(read.loop, state.loop);
    for (const auto part : {&ViewState::play_range, &ViewState::visible_time}) {
      ASSERT_EQ((read.*part).has_value(), (state.*part).has_value());
      if (!(state.*part)) continue;
      ASSERT_EQ((read.*part)->begin_s, (state.*part)->begin_s);
      ASSERT_EQ((read.*part)->end_s, (state.*part)->end_s);
    }
    ASSERT_EQ(read.quantity, state.quantity);
    ASSERT_EQ(read.range, state.range);
    ASSERT_EQ(read.transfer.has_value(), state.transfer.has_value());
    ASSERT_EQ(read.settings.mode, state.settings.mode);
    ASSERT_EQ(read.settings.step_voxels, state.settings.step_voxels);
    ASSERT_EQ(read.settings.mida_gamma, state.settings.mida_gamma);
    ASSERT_EQ(read.settings.exact, state.settings.exact);
    ASSERT_EQ(read.settings.shading, state.settings.shading);
    ASSERT_EQ(std::isnan(read.settings.iso_value), std::isnan(state.settings.iso_value));
    if (!std::isnan(state.settings.iso_value)) {
      ASSERT_EQ(read.settings.iso_value, state.settings.iso_value);
    }
    ASSERT_EQ(read.settings.iso_opacity, state.settings.iso_opacity);
    ASSERT_EQ(read.settings.vertical_exaggeration, state.settings.vertical_exaggeration);
    ASSERT_EQ(read.settings.planes, state.settings.planes);
    ASSERT_EQ(read.theme, state.theme);
    ASSERT_EQ(read.show_terrain, state.show_terrain);
    ASSERT_EQ(read.show_emitters, state.show_emitters);
    ASSERT_EQ(read.coast, state.coast);
    ASSERT_EQ(read.graticule, state.graticule);
    ASSERT_EQ(read.show_compass, state.show_compass);
    ASSERT_EQ(read.show_scale_bar, state.show_scale_bar);
    ASSERT_EQ(read.range_rings.size(), state.range_rings.size());
    for (std::size_t r = 0; r < read.range_rings.size(); ++r)
      ASSERT_EQ(toString(read.range_rings[r]), toString(state.range_rings[r]));
    ASSERT_EQ(read.units, state.units);
    ASSERT_EQ(read.field_unit, state.field_unit);
    ASSERT_EQ(read.positions, state.positions);
    ASSERT_EQ(read.size, state.size);
    ASSERT_EQ(read.edits, state.edits);
    ASSERT_EQ(read.compare, state.compare);
    ASSERT_EQ(read.open_panels, state.open_panels);
  }
}

TEST(ViewState, KeysThatAreNotGivenHaveTheirDefault) {
  EXPECT_EQ(viewStateText(parseViewState("{\"schema_version\": 1}", "a")), viewStateText({}));
  const ViewState state =
      parseViewState("schema_version: 1\ncamera: orbit:azimuth_deg=10\ntheme: light\n", "a");
  EXPECT_EQ(state.camera.azimuth_deg, 10);
  EXPECT_EQ(state.theme, render::Theme::light);
  EXPECT_EQ(state.size, (render::ImageSize{1280, 720}));
}

std::string refusalOf(const std::string& text) {
  return errorOf([&] { parseViewState(text, "a.json"); });
}

TEST(ViewState, ErrorsHaveLocationAndReason) {
  const std::string head = "{\"schema_version\": 1,\n ";
  EXPECT_EQ(refusalOf(head + "\"camera\": \"orbit:azimuth_deg=400\"}"),
            "a.json:2:12: camera 'orbit:azimuth_deg=400': azimuth_deg '400': expected a number -360..360");
  EXPECT_EQ(refusalOf(head + "\"rat\": 1}"),
            "a.json:2:2: unknown key 'rat' of the view; did you mean 'rate'?");
  EXPECT_EQ(refusalOf(head + "\"size\": [0, 10]}"),
            "a.json:2:11: item 1 of 'size' is 0, outside the allowed range 1 to 32767");
  EXPECT_EQ(refusalOf(head + "\"loop\": 1}"), "a.json:2:10: 'loop' must be true or false, not '1'");
  EXPECT_EQ(refusalOf(head + "\"play_range\": {\"begin_s\": 2, \"end_s\": 2}}"),
            "a.json:2:40: 'end_s' is 2, not above 'begin_s', 2");
  EXPECT_EQ(refusalOf(head + "\"range\": {\"min\": 1, \"max\": 0.5}}"),
            "a.json:2:29: 'max' is 0.5, not above 'min', 1");
  EXPECT_EQ(refusalOf(head + "\"planes\": [\"horizontal:altitude_m=1\", \"vertical:bearing_deg=999\"]}"),
            "a.json:2:40: plane 'vertical:bearing_deg=999': bearing_deg '999': expected a number -360..360");
  EXPECT_THAT(refusalOf(head + "\"edits\": [\"a.b=1\", \"power\"]}"),
              HasSubstr("a.json:2:21: 'power' is not an edit; write PATH=VALUE"));
  EXPECT_THAT(refusalOf(head + "\"mode\": \"fog\"}"),
              HasSubstr("a.json:2:10: 'mode' must be one of dvr, mida, mip, iso, not the quoted text 'fog'"));
  EXPECT_THAT(refusalOf(head + "\"bookmarks\": [{\"name\": \"a\"}]}"),
              HasSubstr("missing key 'camera' of the bookmark"));
  EXPECT_THAT(refusalOf("{}"), HasSubstr("missing key 'schema_version' of the view"));
  EXPECT_THAT(refusalOf("[]"), HasSubstr("the view must be a set of keys, not a list"));
  EXPECT_THAT(refusalOf(""), HasSubstr("the file is empty"));
}

TEST(ViewState, AllErrorsAreReportedAtOnce) {
  const std::string message =
      refusalOf("{\"schema_version\": 1,\n \"theme\": \"pink\",\n \"loop\": \"no\",\n \"time_s\": \"x\"}");
  EXPECT_THAT(message, HasSubstr("a.json:2:11: "));
  EXPECT_THAT(message, HasSubstr("\na.json:3:10: "));
  EXPECT_THAT(message, HasSubstr("\na.json:4:12: "));
}

TEST(ViewState, ANewerVersionIsRefusedWithOneError) {
  EXPECT_EQ(refusalOf("{\"schema_version\": 2, \"new\": 1, \"newer\": 2}"),
            "a.json:1:20: 'schema_version' is 2; this program reads 1");
}

TEST(ViewState, TransferFunctionHasFormOfItsOwnFile) {
  const std::string head = "{\"schema_version\": 1, \"transfer\": {\"schema_version\": 1, \"domain\": ";
  const std::string tail = ", \"opacity\": [{\"at\": 0, \"opacity\": 0}, {\"at\": 1, \"opacity\": 0.5}]}}";
  const ViewState state =
      parseViewState(head + "\"value\", \"unit\": \"dB\", \"colors\": \"viridis\"" + tail, "a");
  ASSERT_TRUE(state.transfer);
  EXPECT_EQ(state.transfer->unit, "dB");
  EXPECT_EQ(state.transfer->colors.size(), 17u);
  EXPECT_EQ(refusalOf(head + "\"relative\", \"colors\": \"viridis\"" + tail),
            "a.json:1:67: 'domain' must be value here: no volume gives the range");
  EXPECT_THAT(refusalOf(head + "\"value\", \"colors\": \"jet\"" + tail),
              HasSubstr("'colors' must be one of viridis, cividis"));
}

TEST(ViewState, UnreadableValuesAreNotWritten) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.view.json";
  ViewState state;
  writeViewState(file, state);
  const std::string before = readFile(file);
  state.camera.fov_deg = 500;
  EXPECT_THAT(errorOf([&] { writeViewState(file, state); }),
              HasSubstr("fov_deg '500': expected a number 1..150"));
  EXPECT_EQ(readFile(file), before);
  EXPECT_EQ(viewStateText(readViewState(file)), before);
}

TEST(ViewState, AComparedFileIsNamedRelativeToTheViewFile) {
  const TemporaryFolder folder;
  for (const char* name : {"views", "data", "elsewhere"}) std::filesystem::create_directory(folder / name);
  writeFile(folder / "data/other.yaml", "");
  ViewState state;
  {
    const WorkingFolder in(folder.path());
    state.compare = "data/other.yaml";
    writeViewState("views/a.view.json", state);
    EXPECT_EQ(readViewState("views/a.view.json").compare, "data/other.yaml");
  }
  EXPECT_THAT(readFile(folder / "views/a.view.json"), HasSubstr("\"compare\": \"../data/other.yaml\""));
  EXPECT_EQ(readViewState(folder / "views/a.view.json").compare, folder / "data/other.yaml");
  const WorkingFolder in(folder / "elsewhere");
  EXPECT_EQ(readViewState("../views/a.view.json").compare, "../data/other.yaml");
  state.compare = folder / "data/other.yaml";
  writeViewState("b.view.json", state);
  EXPECT_THAT(readFile("b.view.json"), HasSubstr("\"compare\": \"" + state.compare + "\""));
  state.compare = "original";
  writeViewState("b.view.json", state);
  EXPECT_EQ(readViewState("b.view.json").compare, "original");
}

TEST(ViewState, PlacesAndThePictureOnTheGroundAreNamedRelativeToTheViewFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "views");
  ViewState state;
  state.drape = folder / "chart.tif";
  state.places = {"/elsewhere/a.geojson"};
  writeViewState(folder / "views/a.view.json", state);
  EXPECT_EQ(readViewState(folder / "views/a.view.json").drape, state.drape) << "an absolute name stays";
  writeFile(
      folder / "views/b.view.json",
      R"({"schema_version": 1, "drape": "../chart.tif", "places": ["b.geojson", "/elsewhere/a.geojson"]})");
  const ViewState read = readViewState(folder / "views/b.view.json");
  EXPECT_EQ(read.drape, folder / "chart.tif");
  EXPECT_EQ(read.places, (std::vector<std::string>{folder / "views/b.geojson", "/elsewhere/a.geojson"}));
}

TEST(ViewState, AComparedFileIsFoundThroughASymbolicLinkToTheFolderOfTheView) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::create_directories(folder / "deep/er/views");
  fs::create_directory_symlink(folder / "deep/er/views", folder / "link");
  writeFile(folder / "other.yaml", "");
  const WorkingFolder in(folder.path());
  ViewState state;
  state.compare = "other.yaml";
  writeViewState("link/a.view.json", state);
  EXPECT_THAT(readFile("link/a.view.json"), HasSubstr("\"compare\": \"../../../other.yaml\""));
  EXPECT_EQ(readViewState("deep/er/views/a.view.json").compare, "other.yaml");
  EXPECT_EQ(readViewState("link/a.view.json").compare, fs::canonical("other.yaml"));
  // The compared file itself may be a link, too.
  fs::create_symlink(folder / "other.yaml", folder / "deep/linked.yaml");
  state.compare = "deep/linked.yaml";
  writeViewState("link/a.view.json", state);
  EXPECT_EQ(readViewState("deep/er/views/a.view.json").compare, "deep/linked.yaml");
}

TEST(ViewState, AComparedFileOfAnOldViewFileMayBeInTheWorkingFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "views");
  writeFile(folder / "views/a.view.json", "{\"schema_version\": 1, \"compare\": \"other.yaml\"}");
  const WorkingFolder in(folder.path());
  EXPECT_EQ(readViewState("views/a.view.json").compare, "views/other.yaml") << "there is neither";
  writeFile(folder / "other.yaml", "");
  EXPECT_EQ(readViewState("views/a.view.json").compare, "other.yaml");
  writeFile(folder / "views/other.yaml", "");
  EXPECT_EQ(readViewState("views/a.view.json").compare, "views/other.yaml");
}

/// What a painter that is set to a view draws of a frame.
std::vector<std::uint8_t> pictureOf(const ViewState& view, const Frame& frame, const FrameSource& source) {
  Painter painter(view, source, {});
  painter.setFrame(frame);
  painter.draw({});
  return painter.picture("").rgba;
}

TEST(ViewState, RandomStatesAreDrawnBitByBitAsFromTheirFiles) {
  MadeFrames source(seconds(3));
  const Frame frame = source.frame(2);
  RandomState random(8);
  for (int i = 0; i < 40; ++i) {
    ViewState state = random.make();
    state.size = {72, 54};
    if (state.transfer) state.transfer->unit = "";
    if (state.settings.mode == render::CompositingMode::iso) state.settings.iso_value = 1.25;
    const ViewState read = parseViewState(viewStateText(state), "a");
    ASSERT_TRUE(pictureOf(state, frame, source) == pictureOf(read, frame, source)) << viewStateText(state);
  }
}

TEST(ViewState, APainterDrawsTheSamePictureFromTheFile) {
  ViewState state;
  state.size = {160, 120};
  state.camera.azimuth_deg = 33.3;
  state.camera.distance = 1.1;
  state.settings.mode = render::CompositingMode::mida;
  state.settings.vertical_exaggeration = 1.7;
  state.theme = render::Theme::light;
  MadeFrames source(seconds(3));
  const Frame frame = source.frame(2);
  state.transfer = render::defaultTransferFunction(*frame.volume.host());
  state.transfer->opacities.push_back({state.transfer->highest() + 1, 0.123456789});
  const auto picture = pictureOf(state, frame, source);
  EXPECT_TRUE(picture == pictureOf(parseViewState(viewStateText(state), "a"), frame, source));
  ViewState other = state;
  other.transfer->opacities.back().opacity = 0.9;
  EXPECT_FALSE(picture == pictureOf(other, frame, source));
}

TEST(ViewState, ATransferFunctionOfAnotherUnitIsRefused) {
  MadeFrames source(seconds(1));
  ViewState state;
  state.transfer = render::defaultTransferFunction(*source.frame(0).volume.host());
  state.transfer->unit = "dB";
  Painter painter(state, source, {});
  EXPECT_THAT(errorOf([&] { painter.setFrame(source.frame(0)); }),
              HasSubstr("unit 'dB' is not that of the volume: made is in ''"));
}

}  // namespace
}  // namespace emscape::playback::test
