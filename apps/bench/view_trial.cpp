#include "apps/bench/view_trial.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "base/files/json_writing.h"
#include "emscape/base/error.h"

namespace emscape::app {
namespace {

constexpr double kStateLimit_s = 300;
constexpr double kOrbit_s = 5;
constexpr double kMouseInterval_s = 0.004;
constexpr int kRepeats = 12;
constexpr int kManySeeks = 200;
constexpr int kSeeksAtOnce = 5;  // between two frames of the window
constexpr double kManySeeks_s = 2;
constexpr double kPlay_s = 8;
constexpr int kPlayEdits = 6;
constexpr double kInterface_s = 3;

class ScriptText {
 public:
  void add(const Json& command) { text_ += dumpJson(command) + "\n"; }
  void mark(const char* text) { add({{"do", "mark"}, {"text", text}}); }
  void wait(double seconds) { add({{"do", "wait_s"}, {"seconds", seconds}}); }
  void waitFor(const char* state) {
    add({{"do", "wait_state"}, {"state", state}, {"timeout_s", kStateLimit_s}});
  }
  void orbit() { add({{"do", "orbit"}, {"azimuth_deg", 1.5}}); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void addCameraTrial(ScriptText& script) {
  script.mark("orbit");
  for (int n = 0; n < kOrbit_s / kMouseInterval_s; ++n) {
    script.orbit();
    script.wait(kMouseInterval_s);
  }
  script.mark("orbit ends");
  script.waitFor("exact");
  for (int n = 0; n < kRepeats; ++n) {
    script.mark("input");
    script.orbit();
    script.waitFor("exact");
    script.wait(0.1);
  }
  for (int n = 0; n < kRepeats; ++n) {
    script.orbit();
    // A device that casts every pixel at once has nothing to restore.
    script.add({{"do", "wait_state"}, {"state", "RESTORE"}, {"timeout_s", 0.3}, {"must", false}});
    script.mark("abort");
    script.orbit();
    script.waitFor("exact");
  }
}

/// The cursor moves over the rows of the side panel.
void addInterfaceTrial(ScriptText& script, const ViewTrial& trial) {
  script.mark("interface");
  for (int n = 0; n < kInterface_s / kMouseInterval_s; ++n) {
    script.add({{"do", "mouse"},
                {"x", trial.width - 150 + n % 40},
                {"y", trial.height * (0.15 + 0.45 * (n % 100) / 100)}});
    script.wait(kMouseInterval_s);
  }
  script.mark("interface ends");
}

void addEditTrial(ScriptText& script, const ViewTrial& trial) {
  for (int n = 0; n < kRepeats; ++n) {
    const double value = trial.edit_value * (n % 2 == 0 ? 2 : 1);
    script.mark("edit");
    script.add({{"do", "set"}, {"path", trial.edit->path}, {"value", fmt::format("{:.10g}", value)}});
    script.waitFor("exact");
    script.wait(0.1);
  }
}

/// @param time_s  time of step n of a permutation with large jumps
void addSeekTrial(ScriptText& script, const std::vector<double>& times_s) {
  const auto steps = times_s.size();
  const auto leap = [&](int n) { return times_s[(static_cast<std::size_t>(n) * 7 + 3) % steps]; };
  const int visited = std::min(kRepeats, static_cast<int>(steps));
  for (const char* text : {"seek", "seek cached"}) {
    for (int n = 0; n < visited; ++n) {
      script.mark(text);
      script.add({{"do", "seek"}, {"time_s", leap(n)}});
      script.waitFor("exact");
      script.wait(0.1);
    }
  }
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, steps - 1);
  script.mark("many seeks");
  for (int n = 1; n <= kManySeeks; ++n) {
    script.add({{"do", "seek"}, {"time_s", times_s[any(random)]}});
    if (n % kSeeksAtOnce == 0) script.wait(kSeeksAtOnce * kManySeeks_s / kManySeeks);
  }
  script.mark("many seeks end");
  script.waitFor("exact");
  script.mark("many seeks shown");
}

void addPlayTrial(ScriptText& script, const ViewTrial& trial) {
  script.add({{"do", "first"}});
  script.waitFor("exact");
  script.add({{"do", "loop"}, {"on", true}});
  script.add({{"do", "rate"}, {"value", 1}});
  script.add({{"do", "play"}, {"on", true}});
  script.wait(1);
  script.mark("play");
  script.wait(kPlay_s);
  script.mark("play ends");
  for (int n = 0; n < kPlayEdits && trial.edit; ++n) {
    const double value = trial.edit_value * (n % 2 == 0 ? 2 : 1);
    script.mark("play edit");
    script.add({{"do", "set"}, {"path", trial.edit->path}, {"value", fmt::format("{:.10g}", value)}});
    script.wait(1);
  }
  script.add({{"do", "pause"}});
  script.waitFor("exact");
}

// --- the log ---

using Lines = std::vector<Json>;

bool isMark(const Json& line, const char* text) {
  return line["event"] == "mark" && line["text"] == text;
}

/// Index of the first matching line from `from` on; the number of lines if there is none.
template <class Test>
std::size_t find(const Lines& lines, std::size_t from, const Test& test) {
  while (from < lines.size() && !test(lines[from])) ++from;
  return from;
}

double time_ms(const Json& line) {
  return 1000 * line["t_s"].get<double>();
}

bool isFrame(const Json& line) {
  return line["event"] == "frame";
}

/// Calls a function with the index of the line of each mark.
template <class Call>
void forMarks(const Lines& lines, const char* text, const Call& call) {
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (isMark(lines[n], text)) call(n);
  }
}

/// Time from a mark to the first frame after it that passes a test.
template <class Test>
void addTime(const Lines& lines, std::size_t mark, const Test& test, std::vector<double>& times_ms) {
  const std::size_t n = find(lines, mark, [&](const Json& line) { return isFrame(line) && test(line); });
  if (n < lines.size()) times_ms.push_back(time_ms(lines[n]) - time_ms(lines[mark]));
}

void readCamera(const Lines& lines, ViewTimes& times) {
  const std::size_t begin = find(lines, 0, [](const Json& l) { return isMark(l, "orbit"); });
  const std::size_t end = find(lines, begin, [](const Json& l) { return isMark(l, "orbit ends"); });
  if (end < lines.size()) {
    const double pictures = lines[end]["frame"].get<double>() - lines[begin]["frame"].get<double>();
    times.orbit_fps = 1000 * pictures / (time_ms(lines[end]) - time_ms(lines[begin]));
  }
  forMarks(lines, "input", [&](std::size_t mark) {
    const Json before = lines[mark]["frame"];
    addTime(
        lines, mark, [&](const Json& l) { return l["frame"] != before; }, times.input_to_picture);
    addTime(
        lines, mark, [&](const Json& l) { return l["frame"] != before && l["settled"] == true; },
        times.input_to_exact);
  });
  forMarks(lines, "abort", [&](std::size_t mark) {
    if (lines[mark]["state"] != "RESTORE") return;
    const Json before = lines[mark]["frame"];
    const std::size_t n =
        find(lines, mark, [&](const Json& l) { return isFrame(l) && l["frame"] != before; });
    if (n < lines.size()) times.abort.push_back(lines[n]["input_to_frame_ms"]);
  });
}

void readInterface(const Lines& lines, ViewTimes& times) {
  const std::size_t begin = find(lines, 0, [](const Json& l) { return isMark(l, "interface"); });
  const std::size_t end = find(lines, begin, [](const Json& l) { return isMark(l, "interface ends"); });
  if (end >= lines.size()) return;
  const auto frames = std::count_if(lines.begin() + static_cast<std::ptrdiff_t>(begin),
                                    lines.begin() + static_cast<std::ptrdiff_t>(end), isFrame);
  times.interface_fps = 1000 * static_cast<double>(frames) / (time_ms(lines[end]) - time_ms(lines[begin]));
}

void readEdits(const Lines& lines, ViewTimes& times) {
  forMarks(lines, "edit", [&](std::size_t mark) {
    const Json frame = lines[mark]["frame"], fields = lines[mark]["fields_computed"];
    const auto isNew = [&](const Json& l) {
      return l["frame"] != frame && l["fields_computed"] != fields && l["computing"] == false;
    };
    addTime(lines, mark, isNew, times.edit_to_picture);
    addTime(
        lines, mark, [&](const Json& l) { return isNew(l) && l["settled"] == true; }, times.edit_to_exact);
  });
}

void readSeeks(const Lines& lines, ViewTimes& times) {
  const auto arrives = [](const Json& before) {
    return [&before](const Json& l) {
      return l["frame"] != before["frame"] && l["shown_s"] == l["asked_s"] && l["computing"] == false;
    };
  };
  forMarks(lines, "seek", [&](std::size_t mark) {
    const Json& before = lines[mark];
    const auto isThere = arrives(before);
    const std::size_t n = find(lines, mark, [&](const Json& l) { return isFrame(l) && isThere(l); });
    if (n >= lines.size() || lines[n]["fields_computed"] == before["fields_computed"]) return;
    times.seek.push_back(time_ms(lines[n]) - time_ms(before));
    times.seek_field.push_back(lines[n]["field_ms"]);
  });
  forMarks(lines, "seek cached", [&](std::size_t mark) {
    std::vector<double> time;
    addTime(lines, mark, arrives(lines[mark]), time);
    const std::size_t next = find(lines, mark + 1, [](const Json& l) { return l["event"] == "mark"; });
    if (next < lines.size() && lines[next]["fields_computed"] == lines[mark]["fields_computed"])
      times.seek_cached.insert(times.seek_cached.end(), time.begin(), time.end());
  });
  const std::size_t begin = find(lines, 0, [](const Json& l) { return isMark(l, "many seeks"); });
  const std::size_t end = find(lines, begin, [](const Json& l) { return isMark(l, "many seeks end"); });
  const std::size_t shown = find(lines, end, [](const Json& l) { return isMark(l, "many seeks shown"); });
  if (shown >= lines.size()) return;
  times.seek_count = kManySeeks;
  times.seek_fields = lines[end]["fields_computed"].get<int>() - lines[begin]["fields_computed"].get<int>();
  times.seek_last_shown = lines[shown]["shown_s"] == lines[shown]["asked_s"];
}

void readPlay(const Lines& lines, ViewTimes& times) {
  const std::size_t begin = find(lines, 0, [](const Json& l) { return isMark(l, "play"); });
  const std::size_t end = find(lines, begin, [](const Json& l) { return isMark(l, "play ends"); });
  if (end >= lines.size()) return;
  int fields = 0;
  Json shown_s = lines[begin]["shown_s"];
  for (std::size_t n = begin; n < end; ++n) {
    if (!isFrame(lines[n]) || lines[n]["shown_s"] == shown_s) continue;
    shown_s = lines[n]["shown_s"];
    ++fields;
  }
  times.play_fields_per_s = 1000 * fields / (time_ms(lines[end]) - time_ms(lines[begin]));
  forMarks(lines, "play edit", [&](std::size_t mark) {
    const std::size_t edited =
        find(lines, mark, [](const Json& l) { return isFrame(l) && l["shows_edits"] == false; });
    const std::size_t shown =
        find(lines, edited, [](const Json& l) { return isFrame(l) && l["shows_edits"] == true; });
    if (shown < lines.size())
      times.play_edit_to_picture.push_back(time_ms(lines[shown]) - time_ms(lines[mark]));
  });
}

void readFrames(const Lines& lines, ViewTimes& times) {
  for (const Json& line : lines) {
    if (line["event"] == "start") {
      times.gl_renderer = line["gl_renderer"];
      times.shares_gpu = line["shares_gpu"];
    }
    if (line["event"] == "no_shared_gpu") times.shares_gpu = false;
    if (line["event"] == "first_picture") {
      times.first_picture_ms = time_ms(line);
      times.device = line["device"];
    }
    if (!isFrame(line)) continue;
    if (line["frame"] != 0) {
      const double ui_ms = line["ui_ms"], frame_ms = ui_ms + line["swap_ms"].get<double>();
      times.ui.push_back(ui_ms);
      times.frame.push_back(frame_ms);
      if (line["computing"] == true) {
        times.ui_computing.push_back(ui_ms);
        times.frame_computing.push_back(frame_ms);
      }
    }
    if (times.first_exact_ms == 0 && line["settled"] == true) times.first_exact_ms = time_ms(line);
    times.width = line["picture_width"];
    times.height = line["picture_height"];
    times.rss_mib = line["rss_mib"];
  }
  const std::size_t begin = find(lines, 0, [](const Json& l) { return isMark(l, "idle"); });
  const std::size_t end = find(lines, begin, [](const Json& l) { return isMark(l, "idle ends"); });
  if (end >= lines.size()) return;
  times.idle_cpu_percent = 100 * (lines[end]["cpu_s"].get<double>() - lines[begin]["cpu_s"].get<double>()) /
                           (lines[end]["t_s"].get<double>() - lines[begin]["t_s"].get<double>());
}

}  // namespace

std::string trialScript(const ViewTrial& trial) {
  ScriptText script;
  script.waitFor("exact");
  addInterfaceTrial(script, trial);
  addCameraTrial(script);
  if (trial.edit) addEditTrial(script, trial);
  if (trial.times_s.size() > 1) {
    addSeekTrial(script, trial.times_s);
    addPlayTrial(script, trial);
  }
  script.wait(2);  // for the steps that are computed ahead
  script.mark("idle");
  script.wait(trial.idle_s);
  script.mark("idle ends");
  script.add({{"do", "quit"}});
  return script.text();
}

ViewTimes trialTimes(const std::string& log) {
  Lines lines;
  std::istringstream text(log);
  for (std::string line; std::getline(text, line);) {
    lines.push_back(Json::parse(line, nullptr, false));
    if (lines.back().is_discarded() || !lines.back().contains("event"))
      throw Error(ErrorCode::other, "the window's log has an invalid line: " + line);
  }
  ViewTimes times;
  readFrames(lines, times);
  readInterface(lines, times);
  readCamera(lines, times);
  readEdits(lines, times);
  readSeeks(lines, times);
  readPlay(lines, times);
  return times;
}

}  // namespace emscape::app
