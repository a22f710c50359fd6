// Memory of long playbacks: nothing is kept of past steps. EMSCAPE_UPDATES sets their number of steps.
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "emscape/base/units.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "playback/live/live_view.h"
#include "playback/pictures/real_time_loop.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

constexpr double kMiB = 1 << 20;
constexpr double kTolerance = 1.01;
constexpr render::ImageSize kSize{64, 48};

int updates() {
  const char* const number = std::getenv("EMSCAPE_UPDATES");
  return number == nullptr ? 120 : std::atoi(number);
}

/// quick.yaml on a small grid, one step for each update: the radar scans, the transmitter flies in circles.
std::string flyingScenario(const TemporaryFolder& folder) {
  std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n";
  for (int t_s = 0; t_s <= updates(); ++t_s) {
    const double angle = 2 * kPi * t_s / 40;
    track += std::to_string(t_s) + "," + std::to_string(52 + 0.05 * std::cos(angle)) + "," +
             std::to_string(5 + 0.05 * std::sin(angle)) + ",1500\n";
  }
  folder.write("circles.csv", track);
  return quickScenario(folder, {{"position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}",
                                 "track: {file: circles.csv}"},
                                {"duration_s: 4", "duration_s: " + std::to_string(updates() - 1)},
                                {"dims: [40, 40, 20]", "dims: [16, 16, 8]"}});
}

/// Maxima over the first half of the updates, which fills caches, and over the second.
class MemoryWatch {
 public:
  /// To be called after each update.
  void note() {
    const struct mallinfo2 heap = mallinfo2();
    Memory& half = count_++ < updates() / 2 ? first_ : second_;
    half.allocated_mib =
        std::max(half.allocated_mib, static_cast<double>(heap.uordblks + heap.hblkhd) / kMiB);
    half.resident_mib = std::max(half.resident_mib, residentMiB());
  }

  void expectFlat() const {
    if (first_.allocated_mib == 0)
      GTEST_SKIP() << "the allocator of a sanitizer does not tell what is in use";
    EXPECT_GE(count_, updates());
    EXPECT_LE(second_.allocated_mib, kTolerance * first_.allocated_mib);
    EXPECT_LE(second_.resident_mib, kTolerance * first_.resident_mib);
    std::printf("%d updates: allocated %.3f, then %.3f MiB; resident %.2f, then %.2f MiB\n", count_,
                first_.allocated_mib, second_.allocated_mib, first_.resident_mib, second_.resident_mib);
  }

 private:
  struct Memory {
    double allocated_mib = 0, resident_mib = 0;
  };

  static double residentMiB() {
    constexpr double kPage = 4096;
    double all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * kPage / kMiB;
  }

  Memory first_, second_;
  int count_ = 0;
};

TEST(Memory, IsFlatOverTheUpdatesOfAFieldWithMovingEmitters) {
  const TemporaryFolder folder;
  const auto scenario = scenario::loadScenario(flyingScenario(folder));
  emfield::FieldSolver solver(scenario, nullptr);
  MemoryWatch watch;
  for (int n = 0; n < updates(); ++n) {
    const emfield::FieldChanged changed = solver.update(scenario::snapshotAt(scenario, nullptr, n));
    ASSERT_FALSE(changed.moved.empty()) << n;
    watch.note();
  }
  watch.expectFlat();
}

TEST(Memory, SLOW_IsFlatOverTheStepsAndEditsOfALiveView) {
  const TemporaryFolder folder;
  ViewState shown;
  shown.input = flyingScenario(folder);
  shown.size = kSize;
  LiveOptions options;
  options.controller.epsilon_ms = 1;
  options.min_seek_interval_ms = 0;
  options.cache_bytes = 10 * 16 * 16 * 8 * sizeof(float);
  Event changed;
  LiveView view(shown, options, [&] { changed.set(); });
  const auto settle = [&] {
    while (!view.status().isSettled()) changed.wait();
    ASSERT_EQ(view.status().error, "");
  };
  settle();
  MemoryWatch watch;
  for (int n = 0; n < updates(); ++n) {
    std::shared_ptr<scenario::Scenario> edited;
    if (n % 10 == 5) {
      edited = std::make_shared<scenario::Scenario>(*view.scenario());
      edited->set("emitters.radar.power_w", std::to_string(1000 + n));
    }
    shown.time_s = n;
    view.show(shown, std::move(edited));
    settle();
    watch.note();
  }
  EXPECT_GE(view.status().fields_computed, updates());
  watch.expectFlat();
}

TEST(Memory, IsFlatOverARealTimePlayback) {
  const TemporaryFolder folder;
  FrameSelection selection;
  selection.input = flyingScenario(folder);
  const auto source = openFrameSource(selection, {});
  ViewState view;
  view.size = kSize;
  Painter painter(view, *source, {});
  RealTimeOptions options;
  options.frames_per_s = 1;
  options.controller.pattern = render::Pattern::full;
  options.keep_events = false;
  ManualClock clock;
  MemoryWatch watch;
  RealTimeLoop loop(options, view, *source, painter, {}, clock);
  const RealTimeReport report = loop.play([&](const RealTimeEvent& event) {
    if (event.state == render::ControllerState::busy) watch.note();
  });
  EXPECT_EQ(report.totals.busy, updates());
  EXPECT_TRUE(report.events.empty());
  watch.expectFlat();
}

}  // namespace
}  // namespace emscape::playback::test
