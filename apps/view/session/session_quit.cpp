/// Questions before a loss: at the end of the program, and before a file is replaced.
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <string>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace fs = std::filesystem;

bool Session::hasUnsavedColors() const {
  return transfer_ && saved_colors_ && !(transfer_->function() == *saved_colors_);
}

namespace {

std::size_t stateOfOne(const fs::path& path) {
  std::error_code ignored;
  const std::uintmax_t bytes = fs::is_directory(path, ignored) ? 0 : fs::file_size(path, ignored);
  const auto written = fs::last_write_time(path, ignored).time_since_epoch().count();
  return std::hash<std::string>()(fmt::format("{} {} {}", bytes, written, path.string()));
}

/// Tells whether a file, or a folder or an entry of it, was written since: names, sizes and times, as times
/// alone may be equal within some milliseconds.
std::size_t stateOf(const fs::path& path) {
  std::error_code failed;
  std::size_t state = stateOfOne(path);
  for (fs::directory_iterator entry(path, failed), end; !failed && entry != end; entry.increment(failed))
    state += stateOfOne(entry->path());  // in any order
  return state;
}

}  // namespace

void Session::noteWritten(const std::string& file) {
  std::error_code ignored;
  const fs::path path = fs::absolute(file, ignored).lexically_normal();
  written_[path.string()] = stateOf(path);
}

bool Session::mayReplace(const Command& command) const {
  return command.boolean("replace", !options_.script.empty());
}

void Session::tellWritten(const std::string& file) {
  noteWritten(file);
  tell("written: " + file);
}

bool Session::asksToReplace(const Command& command, const std::string& file) {
  std::error_code ignored;
  const fs::path path = fs::absolute(file, ignored).lexically_normal();
  const bool is_empty = fs::is_directory(path, ignored) && fs::is_empty(path, ignored);
  const auto written = written_.find(path.string());
  const bool is_own = written != written_.end() && written->second == stateOf(path);
  const bool asks = fs::exists(path, ignored) && !is_empty && !is_own;
  panels.replace = asks && !mayReplace(command);
  if (panels.replace) replacing_ = {command, file};
  return panels.replace;
}

void Session::quit(const Command& command) {
  const bool is_script = !options_.script.empty();
  const auto answer = [&](const char* question, const char* of_scripts) {
    return command.has(question) ? command.text(question) : is_script ? of_scripts : "ask";
  };
  const std::string edits = answer("edits", "discard"), recording = answer("recording", "cancel");
  const bool records = files_->recorder.running();
  quit_answers_ = command.arguments;
  panels.unsaved = (records && recording == "ask") || (isUnsaved() && edits == "ask");
  if (panels.unsaved) return;
  if (edits == "save") {
    if (hasUnsavedEdits()) saveScenario(usualScenarioFile(), false);
    if (hasUnsavedColors()) saveTransfer(usualColorsFile());
    Command next{"quit", {{"edits", "ask"}, {"recording", recording}}};
    // A file that could not be written is told, and asked for again.
    return jobs_.run([this, next]() -> BackgroundJobs::Finish { return [this, next] { quit(next); }; });
  }
  quits_when_recorded_ = records && recording == "wait";
  if (!quits_when_recorded_) window_.quit();
}

std::vector<Verb> Session::quitVerbs() {
  return {
      {"replace",
       {},
       "Answers the question whether an existing file is to be replaced: yes",
       [](Session& session, const Command&) {
         if (!session.replacing_) throw Error(ErrorCode::bad_input, "replace: no file is asked for");
         Command command = std::exchange(session.replacing_, std::nullopt)->command;
         command.arguments["replace"] = true;
         session.panels.replace = false;
         session.perform(command);
       }},
      {"quit",
       {{"edits", kText, false, {}, {"save", "discard", "ask"}},
        {"recording", kText, false, {}, {"wait", "cancel", "ask"}}},
       "Ends the program; `edits` and colours that are not saved: save, discard or ask; a running "
       "`recording`: wait for its end, cancel or ask; default: ask, in scripts discard and cancel",
       [](Session& session, const Command& command) { session.quit(command); }},
  };
}

}  // namespace emscape::view
