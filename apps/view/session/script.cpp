#include "apps/view/session/script.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "apps/view/commands/input_queue.h"
#include "base/files/file_reading.h"
#include "base/files/json_writing.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr double kWaitLimit_s = 60;
constexpr int kFramesAfterInput = kFramesToFocus;  // the next key is then taken at once
constexpr int kFramesAfterMouse = 6;               // a drag needs four

bool isWait(const std::string& verb) {
  return verb == "wait_s" || verb == "wait_state" || verb == "wait_frame";
}

/// @throws Error (bad_input) for a part of a drag without the others
void requireWholeDrag(const Command& mouse) {
  const bool has_end = mouse.has("to_x") || mouse.has("to_y");
  if (has_end && !(mouse.has("to_x") && mouse.has("to_y") && mouse.has("button")))
    throw Error(ErrorCode::bad_input, "mouse: expected to_x and to_y together, and a button to drag with");
}

/// Moves, clicks or drags (in ten parts) the mouse, or turns its wheel.
void moveMouse(const Command& command, WindowControl& window) {
  constexpr int kParts = 10;
  const double x = command.number("x"), y = command.number("y");
  const auto moveTo = [&](double to_x, double to_y) {
    window.inject({InputEvent::Kind::cursor, 0, 0, 0, 0, to_x, to_y});
  };
  moveTo(x, y);
  if (command.has("wheel")) window.inject({InputEvent::Kind::wheel, 0, 0, 0, 0, 0, command.number("wheel")});
  if (!command.has("button")) return;
  const auto named =
      std::find_if(mouseButtons().begin(), mouseButtons().end(),
                   [&](const MouseButton& button) { return command.text("button") == button.name; });
  const int button = named->code;  // one of the choices of the verb
  window.inject({InputEvent::Kind::button, button, 0, GLFW_PRESS, 0, 0, 0});
  if (command.has("to_x")) {
    for (int part = 1; part <= kParts; ++part) {
      const double done = static_cast<double>(part) / kParts;
      moveTo(x + done * (command.number("to_x") - x), y + done * (command.number("to_y") - y));
    }
  }
  window.inject({InputEvent::Kind::button, button, 0, GLFW_RELEASE, 0, 0, 0});
}

bool holds(const Json& actual, const std::string& op, const Json& value) {
  if (op == "==") return actual == value;
  if (op == "!=") return actual != value;
  if (!actual.is_number() || !value.is_number()) return false;
  const double a = actual.get<double>(), b = value.get<double>();
  if (op == "<") return a < b;
  if (op == "<=") return a <= b;
  if (op == ">") return a > b;
  return op == ">=" && a >= b;
}

/// @throws Error (bad_input): not JSON; a key that is given twice
Json parseLine(const std::string& line) {
  std::set<std::string> keys;
  std::string twice;
  const auto noteKey = [&](int depth, Json::parse_event_t event, const Json& key) {
    const bool is_key = event == Json::parse_event_t::key && depth == 1;
    if (is_key && !keys.insert(key.get<std::string>()).second) twice = key.get<std::string>();
    return true;
  };
  Json object = Json::parse(line, noteKey, false);
  if (object.is_discarded()) throw Error(ErrorCode::bad_input, "not JSON");
  if (!twice.empty()) throw Error(ErrorCode::bad_input, fmt::format("{} is given twice", twice));
  return object;
}

/// Time (s) from the start of a command's line; empty if it has none. @throws Error (bad_input)
std::optional<double> delayOf(const Json& object) {
  if (!object.contains("at_s")) return std::nullopt;
  requireAllowed(object["do"].get<std::string>(), {"at_s", kNumber, false, {0}}, object["at_s"]);
  return object["at_s"].get<double>();
}

}  // namespace

Script::Script(const std::string& file) {
  std::istringstream text(readTextOrPipe(file));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    const SourceLocation location{file, number, 0};
    try {
      const Json object = parseLine(line);
      lines_.push_back({location, parseCommand(object), delayOf(object)});
      requireAllowed(lines_.back().command);
      if (lines_.back().command.verb == "mouse") requireWholeDrag(lines_.back().command);
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_input, location, error.message());
    }
  }
}

bool Script::waitIsOver(const Line& line, const Session& session, double now_s) {
  const Command& command = line.command;
  if (!waits_since_s_) {
    waits_since_s_ = now_s;
    return false;  // waits at least one frame, so that earlier requests have reached the workers
  }
  const double waited_s = now_s - *waits_since_s_;
  if (command.verb == "wait_s") return waited_s >= command.number("seconds");
  const std::string state = command.text("state");
  bool over = false;
  if (command.verb == "wait_frame") {
    over = session.hasField();
  } else if (state == "IDLE" || state == "exact") {
    over = session.settled();
  } else if (state == "recorded") {
    over = !session.files().recorder.running();
  } else {
    over = state == render::toString(session.status().state);
  }
  const double limit_s = command.number("timeout_s", kWaitLimit_s);
  if (!over && waited_s > limit_s) {
    if (!command.boolean("must", true)) return true;
    throw Error(ErrorCode::check_failed, line.location,
                fmt::format("{} {}: not within {:g} s; the state is {}", command.verb, state, limit_s,
                            dumpJson(session.report())));
  }
  return over;
}

void Script::expect(const Line& line, const Session& session) const {
  const Json report = session.report();
  const std::string key = line.command.text("key"), op = line.command.text("op");
  if (!report.contains(key)) {
    throw Error(ErrorCode::bad_input, line.location, fmt::format("expect: there is no key '{}'", key));
  }
  const Json& value = line.command.arguments["value"];
  if (!holds(report[key], op, value)) {
    throw Error(
        ErrorCode::check_failed, line.location,
        fmt::format("expected {} {} {}, but it is {}", key, op, dumpJson(value), dumpJson(report[key])));
  }
}

void Script::mark(const std::string& text, Session& session) const {
  Json fields{{"text", text}};
  fields.update(session.report());
  session.log().write("mark", fields);
}

void Script::run(Session& session, WindowControl& window, double now_s) {
  if (frames_to_wait_ > 0 && --frames_to_wait_ > 0) return;
  for (; !finished(); ++next_, waits_since_s_.reset()) {
    if (session.isAnswering()) return;
    const Line& line = lines_[next_];
    if (line.at_s && now_s < *line.at_s) return;
    const std::string& verb = line.command.verb;
    if (isWait(verb)) {
      if (!waitIsOver(line, session, now_s)) return;
    } else if (verb == "expect") {
      expect(line, session);
    } else if (verb == "mark") {
      mark(line.command.text("text"), session);
    } else if (verb == "key") {
      window.press(parseChord(line.command.text("key")));
    } else if (verb == "mouse") {
      moveMouse(line.command, window);
    } else {
      session.perform(line.command);
    }
    if (verb == "key" || verb == "mouse" || verb == "resize" || verb == "scale" || verb == "screenshot") {
      frames_to_wait_ = verb == "mouse" ? kFramesAfterMouse : kFramesAfterInput;
      ++next_;
      waits_since_s_.reset();
      return;
    }
  }
}

std::optional<double> Script::nextRun_s(double now_s) const {
  constexpr double kPolling_s = 0.01;
  if (finished()) return std::nullopt;
  if (frames_to_wait_ > 0) return 0;
  const Line& line = lines_[next_];
  if (line.at_s && *line.at_s > now_s) return *line.at_s - now_s;
  if (waits_since_s_ && line.command.verb == "wait_s")
    return std::max(0.0, *waits_since_s_ + line.command.number("seconds") - now_s);
  return kPolling_s;
}

}  // namespace emscape::view
