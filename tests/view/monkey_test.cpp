/// A simulated user who makes random input at random times.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <thread>

#include "tests/view/window_fixture.h"

namespace emscape::test {
namespace {

/// Duration (s): EMSCAPE_MONKEY_S, otherwise 3.
double duration_s() {
  const char* text = std::getenv("EMSCAPE_MONKEY_S");
  return text == nullptr ? 3 : std::strtod(text, nullptr);
}

constexpr double kBegin_s = 2, kMeasured_s = 30;  // from this duration on memory is measured

class Monkey {
 public:
  explicit Monkey(unsigned seed) : random_(seed) {}

  Json next() {
    switch (pick(14)) {
      case 0:
      case 1:
        return {{"do", "seek"}, {"time_s", real(-5, 130)}};
      case 2:
        return {{"do", "resize"}, {"width", size(1920)}, {"height", size(1080)}};
      case 3:
        return {{"do", "set"}, {"path", "emitters.radar.power_w"}, {"value", std::to_string(real(-1, 1e4))}};
      case 4:
        return {{"do", "set"},
                {"path", "emitters.radar.frequency_hz"},
                {"value", std::to_string(real(1e8, 1e10))}};
      case 5:
        return {{"do", pick(2) ? "undo" : "redo"}};
      case 6:
        return {{"do", "orbit"}, {"azimuth_deg", real(-180, 180)}, {"elevation_deg", real(-30, 30)}};
      case 7:
        return {{"do", "dolly"}, {"factor", real(0.3, 3)}};
      case 8:
        return {{"do", "key"},
                {"key", one({"Space", "Left", "Right", "Home", "End",    "M",       "I",      "T",
                             "W",     "Tab",  "Esc",   "D",    "F",      "R",       "G",      "B",
                             "E",     "X",    "J",     "L",    "F1",     "Shift+T", "Ctrl+1", "1",
                             "V",     "S",    "P",     "C",    "Ctrl+Z", "Shift+F", "Shift+R"})}};
      case 9:
        return {{"do", "mouse"},        {"x", real(0, 800)},
                {"y", real(0, 600)},    {"button", one({"left", "middle", "right"})},
                {"to_x", real(0, 800)}, {"to_y", real(0, 600)}};
      case 10:
        return {{"do", "mouse"}, {"x", real(0, 800)}, {"y", real(0, 600)}, {"wheel", real(-3, 3)}};
      case 11:
        return {{"do", "opacity"}, {"factor", real(0.3, 3)}};
      case 12:
        return {{"do", "pattern"}, {"pattern", one({"auto", "full", "quarter", "columns", "adaptive"})}};
      default:
        return {{"do", "play"}};
    }
  }
  double pause_s() { return pick(4) == 0 ? real(0, 0.4) : 0.01; }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int size(int largest) { return pick(3) == 0 ? 1 + pick(3) : 1 + pick(largest); }
  std::string one(const std::vector<std::string>& of) {
    return of[static_cast<std::size_t>(pick(static_cast<int>(of.size())))];
  }

  std::mt19937 random_;
};

TEST_F(Window, RandomInputKeepsItRunningWithConstantMemory) {
  const double seconds = duration_s();
  Monkey monkey(7);
  std::string script = R"({"do":"wait_frame"}
)";
  if (seconds >= kMeasured_s) {  // the largest picture first: its memory is part of the initial amount
    script += R"({"do":"resize","width":1920,"height":1080}
{"do":"panel","name":"all","open":false}
{"do":"wait_s","seconds":0.5}
{"do":"pattern","pattern":"adaptive"}
{"do":"orbit","azimuth_deg":20}
{"do":"wait_state","state":"exact"}
{"do":"panel","name":"all","open":true}
)";
  }
  for (double at_s = kBegin_s; at_s < kBegin_s + seconds; at_s += 0.05 + monkey.pause_s()) {
    Json command = monkey.next();
    command["at_s"] = at_s;
    script += command.dump() + "\n";
  }
  script += R"({"do":"pause"}
{"do":"key","key":"Esc"}
{"do":"resize","width":640,"height":480}
{"do":"wait_s","seconds":0.5}
{"do":"wait_state","state":"exact","timeout_s":120}
{"do":"quit"}
)";
  RunningProgram program(viewOf(quick(), script),
                         environment() + "ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16;");
  if (hasProgram("xdotool")) {  // minimised and shown again
    const std::string window = environment() + "w=$(xdotool search --name emscape | head -n 1);";
    for (int n = 0; n < std::max(1.0, seconds / 5); ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(n == 0 ? 2500 : 4000));
      std::system(
          ("sh -c '" + window + "xdotool windowunmap $w; sleep 0.5; xdotool windowmap $w' 2>/dev/null")
              .c_str());
    }
  }
  const ProgramResult result = program.wait();
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find("Sanitizer"), std::string::npos) << result.err;
  if (seconds < kMeasured_s) return;
  // All volumes and caches have been created after the first 20 s.
  const double middle_s = (20 + seconds) / 2;
  double early_mib = 0, late_mib = 0;
  for (const Json& line : log("frame")) {
    const double at_s = line["t_s"].get<double>() - kBegin_s, mib = line["rss_mib"];
    double& largest = at_s < middle_s ? early_mib : late_mib;
    largest = std::max(largest, mib);
  }
  EXPECT_GT(early_mib, 0);
  EXPECT_LT(late_mib, 1.05 * early_mib) << "MiB at most from the middle on, and before";
}

}  // namespace
}  // namespace emscape::test
