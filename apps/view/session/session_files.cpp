/// Verbs of files: opening, reloading, saving, autosaves, quitting.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/view/files/file_endings.h"
#include "apps/view/files/recent_files.h"
#include "apps/view/files/recordings.h"
#include "apps/view/session/session.h"
#include "base/text/failure_text.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/save_scenario.h"

namespace emscape::view {
namespace {

constexpr double kKeepAfter_s = 2;

}  // namespace

// --- opening ---

void Session::requireInput() const {
  if (!hasInput()) throw Error(ErrorCode::bad_input, "nothing is open: open a scenario or volumes first");
}

void Session::browse(FileBrowser::Purpose purpose, const std::string& proposed) {
  files_->browser.open(purpose, std::filesystem::path(document()).parent_path(), proposed);
  panels.open = true;
}

void Session::ask(OpenRequest request) {
  files_->opening = {std::filesystem::path(request.file).filename().string(), {}};
  files_->request = std::move(request);
  files_->is_opening = true;
  panels.open = panels.restore = asks_to_restore_ = false;
}

void Session::shown(const std::vector<std::string>& left_out) {
  is_on_screen_ = true;
  if (options_.stream) return;  // its file is not the user's
  for (const std::string& edit : left_out) files_->messages->add(edit);
  if (!left_out.empty())
    tell(fmt::format("{} of the view {} left out, as {} any more: see the warnings",
                     left_out.size() == 1 ? "1 part" : fmt::format("{} parts", left_out.size()),
                     left_out.size() == 1 ? "is" : "are",
                     left_out.size() == 1 ? "it does not apply" : "they do not apply"),
         true);
  jobs_.run([this, input = options_.namesake()]() -> BackgroundJobs::Finish {
    auto examples = input.empty() ? findExamples() : std::vector<Example>();
    return [this, examples = std::move(examples),
            recent = input.empty() ? readRecentFiles() : addRecentFile(input)] {
      files_->recent = recent;
      if (!examples.empty()) files_->examples = examples;
    };
  });
  if (options_.offers_kept_view && hasInput()) lookForKeptView();
}

// --- changes on the disk ---

std::vector<std::string> Session::sources() const {
  return isImported() ? sourcesOfRecording(options_.made_of) : std::vector<std::string>{options_.view.input};
}

/// Not the files that the program makes of a recording, which it writes again each time that this is opened.
void Session::watchFiles() {
  if (options_.stream || !hasInput()) return;
  std::vector<std::string> files = sources();
  if (!options_.view.scenario.empty()) files.push_back(options_.view.scenario);
  const std::string made = std::filesystem::path(options_.view.input).parent_path().string() + "/";
  const auto named = edits_ ? scenario::filesOf(*edits_->scenario()) : std::vector<std::string>();
  for (const std::string& file : named) {
    if (!isImported() || file.compare(0, made.size(), made) != 0) files.push_back(file);
  }
  file_watch_.watch(files);
}

void Session::takeChangedFiles() {
  const std::vector<std::string> changed = file_watch_.takeChanged();
  if (changed.empty()) return;
  for (const std::string& file : changed) {
    if (std::find(changed_files_.begin(), changed_files_.end(), file) == changed_files_.end()) {
      changed_files_.push_back(file);
    }
    log_.write("changed_on_disk", {{"file", file}});
  }
  panels.changed = touched_ = true;
}

// --- edits ---

bool Session::hasUnsavedEdits() const {
  const bool is_other = edits_ && (edits_->isModified() || opened_unsaved_);
  return is_other && !edits_->edits().empty();  // without edits it is as in its file
}

bool Session::working() const {
  return jobs_.busy() || !picture_file_.empty() || files_->is_opening || isAnswering();
}

std::string Session::usualScenarioFile() const {
  if (!saved_as_.empty()) return saved_as_;
  const std::filesystem::path scenario_file(scenario()->file);
  return besideInput(options_.made_of.empty() ? scenario_file.string() : options_.made_of,
                     ".edited" + scenario_file.extension().string());
}

void Session::saveScenario(const std::string& file, bool is_named, bool asks_again) {
  const bool is_imported = isImported();  // its tracks are in a folder of ours
  jobs_.run([this, file, is_named, asks_again, is_imported, saved = scenario()]() -> BackgroundJobs::Finish {
    try {
      if (is_imported) {
        scenario::saveWithFiles(*saved, file);
      } else {
        scenario::saveScenario(*saved, file);
      }
    } catch (const Error& error) {
      if (!asks_again) throw;
      return [this, file, why = failureText(error)] {
        if (!isOccupied()) browse(FileBrowser::Purpose::save_scenario, file);
        tell(why, true);
      };
    }
    const auto recent = is_named && !options_.stream ? addRecentFile(file) : std::vector<std::string>();
    return [this, file, is_named, saved, recent] {
      if (is_named) {
        saved_as_ = file;
        files_->browser.forgetFolder();
      }
      if (!recent.empty()) files_->recent = recent;
      if (scenario() == saved) {
        edits_->markSaved();
        opened_unsaved_ = false;
      }
      keep_at_s_ = log_.now_s();  // the autosave is obsolete
      tellWritten(file);
      if (status_.failed)
        tell(fmt::format("written: {}, although its field cannot be computed: {}", file, status_.error),
             true);
    };
  });
}

bool Session::isOccupied() const {
  return files_->is_typing || isDialogOpen(panels);
}

void Session::takeOver(const Session& before) {
  for (bool Panels::*const panel : {&Panels::help, &Panels::warnings, &Panels::side, &Panels::hidden})
    panels.*panel = before.panels.*panel;
  if (options_.view.input != before.options_.view.input) return;
  selected_ = before.selected_;
  if (options_.offers_kept_view) return;
  saved_as_ = before.saved_as_;  // its view is taken along, with its edits
  written_ = before.written_;
}

void Session::lookForKeptView() {
  jobs_.run([this, autosaves = files_->autosaves, input = options_.view.input,
             written = sources()]() -> BackgroundJobs::Finish {
    std::optional<playback::AutosavedView> found = autosaves->find(input, written);
    return [this, found = std::move(found)] {
      kept_view_ = found;
      asks_to_restore_ = found && options_.script.empty();
    };
  });
}

/// Writes the autosave shortly after the last edit, and removes it when the edits are saved or undone.
void Session::keepEdits(double now_s) {
  if (!edits_ || dragging_ || isDragging()) return;
  if (edits_->scenario()->hash != kept_hash_) {
    const bool is_opened = kept_hash_.empty() && !opened_unsaved_;
    kept_hash_ = edits_->scenario()->hash;
    if (!is_opened) keep_at_s_ = now_s + kKeepAfter_s;
  }
  if (!keep_at_s_ || now_s < *keep_at_s_) return;
  keep_at_s_.reset();
  if (hasUnsavedEdits()) {
    keepView();
  } else {
    dropKeptView();
  }
}

void Session::keepView() {
  if (options_.stream) return;  // no other run has its scenario
  has_kept_ = true;
  jobs_.run([this, autosaves = files_->autosaves, input = options_.view.input,
             view = viewState()]() -> BackgroundJobs::Finish {
    autosaves->keep(input, view);
    return [this] { log_.write("autosave"); };
  });
}

void Session::dropKeptView() {
  if (!has_kept_) return;
  has_kept_ = false;
  jobs_.run([autosaves = files_->autosaves, input = options_.view.input]() -> BackgroundJobs::Finish {
    autosaves->remove(input);
    return {};
  });
}

void Session::leave(bool keeps_edits) {
  if (keeps_edits && hasUnsavedEdits()) {
    keepView();
  } else {
    dropKeptView();
  }
}

void Session::leaveForKept() {
  // At once, not by jobs: the next session's come after it.
  playback::Autosaves& autosaves = *files_->autosaves;
  const std::string& input = options_.view.input;
  try {
    if (hasUnsavedEdits()) {  // they stay in a file of theirs
      autosaves.keep(input, viewState());
    } else if (has_kept_) {
      autosaves.remove(input);
    }
  } catch (const std::exception& error) {
    files_->messages->add(failureText(error));
  }
  autosaves.adopt(input);
}

std::vector<Verb> Session::fileVerbs() {
  return {
      {"open",
       {{"file", kText, false}, {"scenario", kText, false}},
       "Opens a scenario, or volumes with an optional `scenario`; shows a view file; takes colours "
       "from "
       "a transfer function; without a file: asks for it",
       [](Session& session, const Command& command) {
         if (command.has("file")) {
           session.ask({command.text("file"), command.text("scenario"), std::nullopt, false});
         } else {
           session.browse(FileBrowser::Purpose::input);
         }
       }},
      {"open_recent",
       {{"number", kNumber, false, {1, kMaxRecentFiles, true}}},
       "Opens one of the inputs that were opened last, 1..10; default: the one before this",
       [](Session& session, const Command& command) {
         const auto number = static_cast<std::size_t>(command.number("number", session.hasInput() ? 2 : 1));
         const std::vector<std::string>& recent = session.files_->recent;
         if (number > recent.size()) {
           throw Error(ErrorCode::bad_input, fmt::format("open_recent: there are {} inputs", recent.size()));
         }
         session.ask({recent[number - 1], "", std::nullopt, false});
       }},
      {"reload",
       {},
       "Reads the input again; edits that still apply are kept",
       [](Session& session, const Command&) {
         session.requireInput();
         const ViewOptions& options = session.options_;
         session.ask({options.stream ? options.view.input : options.namesake(), options.view.scenario,
                      session.viewState(), session.hasUnsavedEdits()});
       }},
      {"save",
       {{"file", kText, false, {}, {}, requireScenarioEnding}, {"replace", kBoolean, false}},
       "Writes the changed scenario; default: NAME.edited.yaml next to the input. With `replace` an existing "
       "file is replaced without a question, as in scripts; this also holds for the other verbs that write",
       [](Session& session, const Command& command) {
         if (!session.edits_) throw Error(ErrorCode::bad_input, "there is no scenario to save");
         const std::string file = command.has("file") ? command.text("file") : session.usualScenarioFile();
         if (session.asksToReplace(command, file)) return;
         const bool is_of_dialog = std::exchange(session.panels.open, false);
         session.saveScenario(file, command.has("file"), is_of_dialog);
       }},
      {"save_as",
       {},
       "Asks for the name under which the changed scenario is written",
       [](Session& session, const Command&) {
         if (!session.edits_) throw Error(ErrorCode::bad_input, "there is no scenario to save");
         const std::filesystem::path file = session.usualScenarioFile();
         session.browse(FileBrowser::Purpose::save_scenario, file.filename().string());
       }},
      {"add_scenario",
       {{"file", kText, false}},
       "Draws the ground and the emitters of a scenario with the volumes; without a file: asks for it",
       [](Session& session, const Command& command) {
         session.requireInput();
         if (session.edits_ && session.view_.scenario.empty()) {
           throw Error(ErrorCode::bad_input, "add_scenario: the input is a scenario");
         }
         if (!command.has("file")) return session.browse(FileBrowser::Purpose::scenario);
         playback::ViewState view = session.viewState();
         view.edits.clear();
         session.ask({session.options_.view.input, command.text("file"), view, false});
       }},
      {"restore",
       {},
       "Shows the view with its edits that was kept when the program did not exit normally",
       [](Session& session, const Command&) {
         if (!session.kept_view_) throw Error(ErrorCode::bad_input, "no edits were kept for this input");
         session.ask({session.options_.view.input, session.options_.view.scenario, session.kept_view_->state,
                      true, true});
       }},
      {"discard",
       {},
       "Removes what was kept when the program did not exit normally",
       [](Session& session, const Command&) {
         session.panels.restore = false;
         if (!session.kept_view_) throw Error(ErrorCode::bad_input, "no edits were kept for this input");
         session.kept_view_.reset();
         session.jobs_.run([autosaves = session.files_->autosaves,
                            input = session.options_.view.input]() -> BackgroundJobs::Finish {
           autosaves->discard(input);
           return {};
         });
         session.lookForKeptView();  // an older one
       }},
  };
}

}  // namespace emscape::view
