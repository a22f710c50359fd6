#include "playback/live/live_view.h"

#include <algorithm>
#include <condition_variable>
#include <thread>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/format/file.h"
#include "tests/playback/playback_samples.h"
#include "tests/support/gpu.h"

namespace emscape::playback::test {
namespace {

using render::ControllerState;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr render::ImageSize kSize{200, 150};

/// A small view that casts a quarter of the rays while it changes.
ViewState smallView(const std::string& input) {
  ViewState view;
  view.input = input;
  view.size = kSize;
  view.pattern = render::Pattern::quarter;
  view.time_s = 0;
  return view;
}

LiveOptions fastOptions() {
  LiveOptions options;
  options.controller.epsilon_ms = 20;
  return options;
}

/// A LiveView, and the sequence of its states.
class Live {
 public:
  explicit Live(const std::string& input) : Live(smallView(input)) {}
  explicit Live(const ViewState& first, const LiveOptions& options = fastOptions()) : shown(first) {
    view = std::make_unique<LiveView>(first, options, [this] { wake(); });
    const std::lock_guard<std::mutex> lock(mutex_);
    has_view_ = true;
  }
  ~Live() {
    pass();  // else threads would wait in wake()
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      has_view_ = false;
    }
    view.reset();
  }

  void waitUntil(const std::function<bool(const LiveStatus&)>& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!condition(view->status())) changed_.wait_for(lock, std::chrono::milliseconds(5));
  }
  /// The settled picture.
  std::shared_ptr<const LivePicture> settled() {
    waitUntil([](const LiveStatus& status) { return status.isSettled(); });
    return view->picture();
  }
  /// Waits for a failure.
  std::string error() {
    waitUntil([](const LiveStatus& status) { return !status.error.empty(); });
    return view->status().error;
  }
  /// States since the last call, without repetitions in a row.
  std::vector<ControllerState> states() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(states_, {});
  }

  /// Threads of the view wait in their next call of wake() until pass(). @param state  in this state alone
  void hold(std::optional<ControllerState> state = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    holds_ = true;
    held_state_ = state;
  }
  void waitUntilHeld() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return held_ > 0; });
  }
  /// Resumes waiting threads. @param next  state in which they wait again
  void pass(std::optional<ControllerState> next = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++passed_;
    held_ = 0;
    holds_ = next.has_value();
    held_state_ = next;
    changed_.notify_all();
  }

 private:
  void wake() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.notify_all();
    if (!has_view_) return;
    const ControllerState state = view->status().state;
    if (states_.empty() || states_.back() != state) states_.push_back(state);
    if (held_state_ && held_state_ != state) return;
    if (!holds_) return;
    ++held_;
    changed_.notify_all();
    changed_.wait(lock, [this, passed = passed_] { return passed_ != passed; });
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<ControllerState> states_;
  bool has_view_ = false;
  bool holds_ = false;
  std::optional<ControllerState> held_state_;
  int held_ = 0;
  int passed_ = 0;

 public:
  ViewState shown;
  std::unique_ptr<LiveView> view;

  void show(const std::function<void(ViewState&)>& change) {
    change(shown);
    view->show(shown);
  }
  void seek(double time_s) {
    show([&](ViewState& to) { to.time_s = time_s; });
  }
  void turn() {
    show([](ViewState& to) { to.camera.azimuth_deg += 30; });
  }
  void edit(const std::string& path, const std::string& value) {
    auto edited = std::make_shared<scenario::Scenario>(*view->scenario());
    edited->set(path, value);
    view->show(shown, std::move(edited));
  }
};

/// The picture that a separate Painter casts in full.
struct Expected {
  explicit Expected(const std::string& file) : view(smallView(file)) {}

  ViewState view;

  render::Image8 picture() const {
    FrameSelection selection(view);
    selection.range.reset();
    selection.independent = true;
    const auto source = openFrameSource(selection, {});
    Painter painter(view, *source, {});
    painter.setFrame(source->frameAt(view.time_s));
    painter.draw(render::FramePlan::exact());
    render::Image8 image;
    painter.fetch(image);
    return image;
  }
};

void expectSame(const std::shared_ptr<const LivePicture>& shown, const Expected& expected) {
  const render::Image8 full = expected.picture();
  ASSERT_EQ(shown->size, full.size);
  EXPECT_TRUE(shown->image.rgba == full.rgba);
  EXPECT_TRUE(std::any_of(full.rgba.begin(), full.rgba.end(), [](std::uint8_t level) { return level > 0; }));
}

constexpr auto kBusyRestoreIdle = {ControllerState::busy, ControllerState::restore, ControllerState::idle};

/// Status text for tetrahedra while something changes: they are projected if OpenGL has a GPU.
std::string busyText() {
  try {
    return render::CellRenderer().projectsOnCpu() ? "marched" : "projected by centroids";
  } catch (const Error&) {
    return "marched";
  }
}

TEST(LiveView, TetrahedraAreProjectedWhileBusyAndMarchedWhenSettled) {
  const TemporaryFolder folder;
  Expected expected(quickScenario(folder));
  expected.view.mesh = "terrain:4,50";
  expected.view.pattern.reset();
  LiveOptions options;
  options.controller.epsilon_ms = 1e6;
  {
    Live busy(expected.view, options);
    busy.waitUntil([](const LiveStatus& status) { return status.frame > 0; });
    EXPECT_EQ(busy.view->status().cells, busyText());
    EXPECT_EQ(busy.view->status().state, ControllerState::busy);
  }
  {
    ViewState view = expected.view;
    view.cells.method = CellMethod::project;
    Live busy(view, options);
    busy.waitUntil([](const LiveStatus& status) { return status.frame > 0; });
    EXPECT_EQ(busy.view->status().cells, "projected by centroids");
  }
  options.controller.epsilon_ms = 20;
  Live live(expected.view, options);
  expectSame(live.settled(), expected);
  EXPECT_EQ(live.view->status().cells, "marched");
  EXPECT_GT(live.view->picture()->cells->field.mesh->cells.size(), 1000);
  live.edit("region.dims", "[10, 12, 4]");
  expected.view.edits = {{"region.dims", "[10, 12, 4]"}};
  const auto changed = live.settled();
  expected.view.transfer = changed->transfer;  // of the first picture's range
  expectSame(changed, expected);
}

TEST(LiveView, ModesThatTetrahedraDoNotHaveAreAnError) {
  const TemporaryFolder folder;
  ViewState view = smallView(quickScenario(folder));
  view.mesh = "terrain:4,50";
  view.settings.mode = render::CompositingMode::mida;
  Live live(view);
  EXPECT_THAT(live.error(), HasSubstr("mode mida: fields on tetrahedra support only mode dvr"));
}

TEST(LiveView, ComparisonShowsEffectOfEditsAndThenTheField) {
  const TemporaryFolder folder;
  Expected expected(quickScenario(folder));
  Live live(expected.view);
  const auto field = live.settled();
  live.show([](ViewState& to) { to.compare = kOriginal; });
  const auto equal = live.settled();
  EXPECT_EQ(equal->volume.info().quantity, "power_density_difference_db");
  EXPECT_EQ(equal->annotations.subtitle, "difference to the original scenario");
  EXPECT_EQ(equal->volume.info().range_max, 0) << "nothing is edited";
  live.edit("emitters.radar.power_w", "100000");
  const auto changed = live.settled();
  EXPECT_GT(changed->volume.info().range_max, 9.9F);
  EXPECT_GE(changed->volume.info().range_min, 0);
  live.show([](ViewState& to) { to.compare.clear(); });
  const auto again = live.settled();
  EXPECT_EQ(again->volume.info().quantity, "power_density_dbwm2");
  EXPECT_EQ(again->annotations.subtitle, "");
  expected.view.edits = {{"emitters.radar.power_w", "100000"}};
  expectSame(again, expected);
}

TEST(LiveView, UndefinedDifferenceIsReportedAndPictureStays) {
  const TemporaryFolder folder;
  ViewState view = smallView(quickScenario(folder));
  view.quantity = "dominant_emitter";
  Live live(view);
  const auto field = live.settled();
  live.show([](ViewState& to) { to.compare = kOriginal; });
  EXPECT_THAT(live.error(), HasSubstr("dominant_emitter: indices have no difference"));
  EXPECT_EQ(live.settled()->volume.info().quantity, "dominant_emitter");
}

TEST(LiveView, EveryKindOfEventSettlesOnFullCast) {
  const TemporaryFolder folder;
  Expected expected(quickScenario(folder));
  Live live(expected.view);
  const auto expectSettled = [&](const char* event) {
    SCOPED_TRACE(event);
    const auto shown = live.settled();
    EXPECT_THAT(live.states(), testing::IsSupersetOf(kBusyRestoreIdle));
    EXPECT_TRUE(shown->status.exact);
    expectSame(shown, expected);
  };
  const auto first = live.settled();
  live.states();
  expectSame(first, expected);
  EXPECT_EQ(first->status.pattern, render::Pattern::quarter);
  EXPECT_EQ(live.view->times_s(), (std::vector<double>{0, 1, 2, 3, 4}));
  expected.view.transfer = first->transfer;

  live.seek(2.2);
  expected.view.time_s = 2.2;
  expectSettled("seek");
  EXPECT_EQ(live.view->picture()->annotations.time, "t = 2.2 s");

  live.edit("emitters.radar.power_w", "900");
  expected.view.edits = {{"emitters.radar.power_w", "900"}};
  expectSettled("edit");
  EXPECT_EQ(live.view->picture()->scenario->emitters[0].power_w, 900);

  expected.view.camera.azimuth_deg = 20;
  live.view->show(expected.view);
  expectSettled("camera");

  for (auto& point : expected.view.transfer->opacities) point.opacity *= 0.5;
  live.view->show(expected.view);
  expectSettled("transfer function");

  expected.view.settings.vertical_exaggeration = 3;
  expected.view.settings.mode = render::CompositingMode::mip;
  live.view->show(expected.view);
  expectSettled("settings");

  expected.view.size = {160, 220};
  live.view->show(expected.view);
  expectSettled("size");

  changeQuantity(expected.view, "snr_db");
  live.view->show(expected.view);
  expectSettled("quantity");
  EXPECT_EQ(live.view->picture()->volume.info().quantity, "snr_db");

  expected.view.settings.map_height_agl_m = 400;
  live.view->show(expected.view);
  expectSettled("map layer");

  changeSplit(expected.view, 0.25);
  live.view->show(expected.view);
  expectSettled("split");
  EXPECT_EQ(live.view->picture()->split_column, 40);
  ASSERT_NE(live.view->picture()->beside, nullptr);
  EXPECT_EQ(live.view->picture()->info().quantity, "snr_db") << "no difference";

  const long long computed = live.view->status().fields_computed;
  expected.view.split = 0.75;
  live.view->show(expected.view);
  expectSettled("line of a split");
  EXPECT_EQ(live.view->picture()->split_column, 120);
  EXPECT_EQ(live.view->status().fields_computed, computed);

  expected.view.split = 0;
  changeComparison(expected.view, "");
  live.view->show(expected.view);
  expectSettled("field again");
  EXPECT_EQ(live.view->picture()->split_column, 0);
}

/// A scenario whose field takes long.
ViewState slowView() {
  ViewState view = smallView(emscape::test::shippedScenario("quick.yaml"));
  view.edits = {{"emitters.radar.propagation", "parabolic_equation"},
                {"emitters.transmitter.propagation", "parabolic_equation"},
                {"region.size_m", "[200000, 200000, 9000]"},
                {"region.dims", "[200, 200, 100]"}};
  return view;
}

TEST(LiveView, BeforeTheFirstFieldTheGroundAndTheEmittersAreShown) {
  LiveOptions options = fastOptions();
  options.begins_without_field = true;
  Live live(slowView(), options);
  live.waitUntil([&](const LiveStatus& status) { return status.frame > 0; });
  const auto first = live.view->picture();
  EXPECT_FALSE(first->has_field);
  EXPECT_EQ(first->annotations.markers.size(), 2U);
  EXPECT_FALSE(first->annotations.legend.has_value());
  EXPECT_TRUE(live.view->status().computing);
  EXPECT_FALSE(live.view->status().exact);
  live.view->showWithoutField();
  const auto cancelled = live.settled();
  EXPECT_FALSE(cancelled->has_field);
  EXPECT_EQ(live.view->status().fields_computed, 0);
  // Another field is requested and shown, with its own colours, in the same place.
  auto edited = std::make_shared<scenario::Scenario>(*cancelled->scenario);
  edited->set("emitters.radar.propagation", "free_space");
  edited->set("emitters.transmitter.propagation", "free_space");
  live.view->show(live.shown, edited);
  const auto shown = live.settled();
  EXPECT_TRUE(shown->has_field);
  EXPECT_EQ(shown->camera.eye_m.x, cancelled->camera.eye_m.x) << "the legend's room was free before";
  EXPECT_EQ(shown->transfer, shown->defaultColors());
}

TEST(LiveView, EventStopsRestorationAndSettledPictureShowsIt) {
  const TemporaryFolder folder;
  Expected expected(quickScenario(folder));
  Live live(expected.view);
  live.settled();
  for (int round = 0; round < 3; ++round) {
    live.hold(ControllerState::restore);
    expected.view.camera.azimuth_deg += 30;
    live.view->show(expected.view);
    live.waitUntilHeld();
    const auto interpolated = live.view->picture();
    expected.view.camera.azimuth_deg += 30;
    live.view->show(expected.view);
    live.pass(ControllerState::busy);  // until the restoration has been stopped
    live.waitUntilHeld();
    EXPECT_EQ(live.view->picture(), interpolated) << "a stopped restoration is not shown";
    EXPECT_FALSE(live.view->status().exact);
    live.pass();
  }
  expectSame(live.settled(), expected);
}

TEST(LiveView, OnTheCpuBusyPicturesAreFinishedInTheHostsMemory) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  live.settled();
  live.view->keepOnDevice(true);
  live.settled();
  live.hold(ControllerState::restore);
  live.turn();
  live.waitUntilHeld();
  const auto busy = live.view->picture();
  EXPECT_EQ(busy->on_device, nullptr);
  EXPECT_EQ(busy->finished.size, kSize);
  live.pass();
}

TEST(LiveView, BusyPicturesStayOnGpuOnRequest) {
  EMSCAPE_NEEDS_GPU();
  const TemporaryFolder folder;
  LiveOptions options = fastOptions();
  options.target.choice = resolveBackend(Backend::cuda);
  Live live(smallView(quickScenario(folder)), options);
  live.settled();
  for (const bool keeps : {true, false}) {
    live.view->keepOnDevice(keeps);
    live.settled();
    live.hold(ControllerState::restore);
    live.turn();
    live.waitUntilHeld();
    const auto busy = live.view->picture();
    EXPECT_EQ(busy->size, kSize);
    ASSERT_EQ(busy->on_device != nullptr, keeps);
    EXPECT_EQ(busy->finished.rgba.empty(), keeps);
    const render::Image8 picture = keeps ? busy->on_device->host() : busy->finished;
    live.pass();
    const auto exact = live.settled();
    EXPECT_EQ(exact->on_device, nullptr);
    ASSERT_EQ(exact->finished.size, picture.size);
    // An interpolated picture of the same scene.
    EXPECT_GT(render::compare(picture, exact->finished).psnr_db, 25) << keeps;
  }
}

TEST(LiveView, SeekingBackUsesCacheAndEditClearsIt) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  for (const double time_s : {0.0, 3.0}) {
    live.seek(time_s);
    live.settled();
  }
  EXPECT_THAT(live.view->status().cached_steps, ElementsAre(0, 3));
  const long long computed = live.view->status().fields_computed;
  live.seek(0);
  EXPECT_EQ(live.settled()->status.shown_s, 0);
  EXPECT_EQ(live.view->status().fields_computed, computed);
  live.edit("emitters.radar.power_w", "1");
  live.settled();
  EXPECT_EQ(live.view->status().fields_computed, computed + 1);
  EXPECT_THAT(live.view->status().cached_steps, ElementsAre(0));
}

TEST(LiveView, RequestedAndShownStepDifferAndPictureStays) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  const auto before = live.settled();
  live.hold();
  live.turn();
  live.waitUntilHeld();  // the casting thread is blocked
  live.seek(3.1);
  const LiveStatus status = live.view->status();
  EXPECT_EQ(status.asked_s, 3.1);
  EXPECT_EQ(status.shown_s, 0);
  EXPECT_TRUE(status.computing);
  EXPECT_FALSE(status.exact);
  EXPECT_EQ(live.view->picture()->status.shown_s, 0);
  live.pass();
  const auto after = live.settled();
  EXPECT_EQ(after->status.shown_s, 3.1) << "between two steps";
  EXPECT_FALSE(live.view->status().computing);
  EXPECT_GT(after->status.frame, before->status.frame);
}

TEST(LiveView, SettingsOutOfRangeAreReportedAndPictureStays) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  const auto before = live.settled();
  live.show([](ViewState& to) { to.settings.step_voxels = 99; });
  EXPECT_EQ(live.error(), "step_voxels 99: expected a number 0.05..10");
  EXPECT_EQ(live.settled(), before);
  live.turn();
  live.settled();
  EXPECT_EQ(live.view->status().error, "");
}

TEST(LiveView, AnEditThatCannotBeComputedLeavesThePictureUntilItIsUndone) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  const auto before = live.settled();
  const auto good = live.view->scenario();
  // Changed directly, bypassing the checks of a file.
  auto bad = std::make_shared<scenario::Scenario>(*good);
  bad->output.quantities = {"no_such_quantity"};
  bad->terrain.emplace();
  bad->terrain->files = {"no_such_file.tif"};
  live.view->show(live.shown, bad);
  EXPECT_THAT(live.error(), HasSubstr("no_such_file.tif"));
  EXPECT_FALSE(live.view->status().computing);
  EXPECT_EQ(live.view->picture()->image.rgba, before->image.rgba);
  EXPECT_EQ(live.view->scenario(), bad);
  live.view->show(live.shown, good);
  live.settled();
  EXPECT_EQ(live.view->status().error, "");
}

TEST(LiveView, UnreadableFileIsReportedAndViewContinues) {
  Live live("no/such/file.yaml");
  EXPECT_EQ(live.error(), "no/such/file.yaml: no such file or folder");
  live.seek(3);
  live.turn();
  EXPECT_EQ(live.view->picture(), nullptr);
  EXPECT_EQ(live.view->scenario(), nullptr);
}

TEST(LiveView, NoThreadWakesWhileIdle) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  live.settled();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const long long before = live.view->status().wake_ups;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(live.view->status().wake_ups, before);
}

TEST(LiveView, LabelsChangeWithoutACast) {
  const TemporaryFolder folder;
  Live live(quickScenario(folder));
  const auto before = live.settled();
  EXPECT_EQ(before->annotations.markers.size(), 2U);
  live.states();
  live.show([](ViewState& to) { to.show_emitters = false; });
  const auto after = live.settled();
  EXPECT_TRUE(after->annotations.markers.empty());
  EXPECT_EQ(after->image.rgba, before->image.rgba);
  EXPECT_THAT(live.states(), testing::Not(testing::Contains(ControllerState::busy)));
}

TEST(LiveView, EmptySizeIsNotDrawn) {
  const TemporaryFolder folder;
  Expected expected(quickScenario(folder));
  ViewState view = expected.view;
  view.size = {};
  Live live(view);
  live.waitUntil([](const LiveStatus& status) { return status.fields_computed == 1 && !status.computing; });
  EXPECT_EQ(live.view->picture(), nullptr);
  live.show([](ViewState& to) { to.size = kSize; });
  expectSame(live.settled(), expected);
  live.show([](ViewState& to) { to.size = {}; });
  live.seek(2);
  live.waitUntil([](const LiveStatus& status) { return !status.computing; });
  EXPECT_EQ(live.view->status().shown_s, 0);
  live.show([](ViewState& to) { to.size = kSize; });
  EXPECT_EQ(live.settled()->status.shown_s, 2);
}

TEST(LiveView, ColorsAreFittedToARequestedRange) {
  const TemporaryFolder folder;
  const std::string input = quickScenario(folder);
  Live live(input);
  const render::TransferFunction fitted = live.settled()->transfer;
  live.seek(2);
  EXPECT_EQ(live.settled()->transfer.lowest(), fitted.lowest()) << "colours stay over the series";
  EXPECT_FALSE(live.view->status().series_range);
  live.view->searchSeriesRange();
  EXPECT_TRUE(live.view->status().searching);
  live.waitUntil([&](const LiveStatus& status) { return status.isSettled(); });
  FrameSelection selection;
  selection.input = input;
  const Frame first = openFrameSource(selection, {})->frame(0);
  const ValueRange series = *first.color_range;
  EXPECT_EQ(*live.view->status().series_range, series);
  EXPECT_EQ(live.settled()->transfer.lowest(), fitted.lowest()) << "what is shown stays";
  live.show([&](ViewState& to) { changeRange(to, series); });
  EXPECT_EQ(live.settled()->transfer.highest(),
            render::defaultTransferFunction(first.info(), series).highest());
  live.show([](ViewState& to) { changeRange(to, {-90, -20}); });
  EXPECT_EQ(live.settled()->transfer.lowest(), -90);
}

TEST(LiveView, VolumesFromFilesAreShownWithTheirTimes) {
  const TemporaryFolder folder;
  MadeFrames made(seconds(3));
  for (int i = 0; i < made.count(); ++i) {
    volume::writeVolumes(folder / ("v_000" + std::to_string(i + 1) + ".vdb"),
                         {made.frame(i).volume.host().get()});
  }
  Live live(folder.path().string());
  live.seek(1.2);
  const auto shown = live.settled();
  EXPECT_EQ(shown->status.shown_s, 1);
  EXPECT_EQ(shown->scenario, nullptr);
  live.view->show(live.shown, std::make_shared<scenario::Scenario>());
  EXPECT_THAT(live.error(), HasSubstr("volumes without a scenario cannot be edited"));
}

TEST(LiveView, EndsWhileWorkIsRunning) {
  const TemporaryFolder folder;
  const std::string input = quickScenario(folder);
  for (int round = 0; round < 10; ++round) {
    ViewState shown = smallView(input);
    LiveView view(shown, fastOptions(), {});
    for (int n = 0; n < 20 * round; ++n) {
      std::shared_ptr<scenario::Scenario> edited;
      if (n % 50 == 49 && view.scenario()) {
        edited = std::make_shared<scenario::Scenario>(*view.scenario());
        edited->set("emitters.radar.power_w", std::to_string(n));
      }
      shown.time_s = n % 5;
      shown.camera.azimuth_deg = n;
      view.show(shown, std::move(edited));
      if (n % 7 == 0) view.searchSeriesRange();
    }
  }
}

}  // namespace
}  // namespace emscape::playback::test
