/// Verbs of files: opening, reloading, saving, autosaves, quitting.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/view/files/file_endings.h"
#include "apps/view/files/recent_files.h"
#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"

namespace emscape::view {
namespace {

constexpr double kKeepAfter_s = 2;

}  // namespace

std::string newPictureName() {
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("emscape-{:04d}.png", number);
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) return name;
  }
}

// --- opening ---

void Session::requireInput() const {
  if (!hasInput()) throw Error(ErrorCode::bad_input, "nothing is open: open a scenario or volumes first");
}

void Session::browse(FileBrowser::Purpose purpose) {
  files_->browser.open(purpose, std::filesystem::path(options_.view.input).parent_path());
  panels.open = true;
}

void Session::ask(OpenRequest request) {
  files_->opening = {std::filesystem::path(request.file).filename().string(), {}};
  files_->request = std::move(request);
  files_->is_opening = true;
  panels.open = panels.restore = false;
}

void Session::shown(const std::string& left_out) {
  is_on_screen_ = true;
  if (!left_out.empty()) tell("these edits do not apply any more: " + left_out, true);
  jobs_.run([this, input = options_.view.input]() -> BackgroundJobs::Finish {
    return [this, recent = input.empty() ? readRecentFiles() : addRecentFile(input)] {
      files_->recent = recent;
    };
  });
  if (options_.offers_kept_view && hasInput()) lookForKeptView();
}

// --- changes on the disk ---

void Session::watchFiles() {
  std::vector<std::string> files;
  for (const std::string& file : {options_.view.input, options_.view.scenario}) {
    if (!file.empty()) files.push_back(file);
  }
  if (edits_) {
    const std::vector<std::string> named = scenario::filesOf(*edits_->scenario());
    files.insert(files.end(), named.begin(), named.end());
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
  return edits_ && (edits_->isModified() || opened_unsaved_);
}

bool Session::working() const {
  return jobs_.busy() || !picture_file_.empty() || files_->is_opening || isAnswering();
}

void Session::saveScenario(const std::string& given_file, bool then_quits) {
  if (!edits_) throw Error(ErrorCode::bad_input, "there is no scenario to save");
  std::string file = given_file;
  if (file.empty()) {
    const std::filesystem::path input(scenario()->file);
    file = (input.parent_path() / (input.stem().string() + ".edited" + input.extension().string())).string();
  }
  jobs_.run([this, file, saved = scenario(), then_quits]() -> BackgroundJobs::Finish {
    scenario::saveScenario(*saved, file);
    return [this, file, saved, then_quits] {
      if (scenario() == saved) {
        edits_->markSaved();
        opened_unsaved_ = false;
      }
      keep_at_s_ = log_.now_s();  // the autosave is obsolete
      tell("written: " + file);
      if (then_quits) window_.quit();
    };
  });
}

void Session::lookForKeptView() {
  jobs_.run([this, autosaves = files_->autosaves, input = options_.view.input]() -> BackgroundJobs::Finish {
    std::optional<playback::AutosavedView> found = autosaves->find(input);
    return [this, found = std::move(found)] {
      kept_view_ = found;
      if (found && options_.script.empty()) panels.restore = true;
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
  has_kept_ = true;
  kept_view_.reset();  // replaced
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
         session.ask({session.options_.view.input, session.options_.view.scenario, session.viewState(),
                      session.hasUnsavedEdits()});
       }},
      {"save",
       {{"file", kText, false, {}, {}, requireScenarioEnding}},
       "Writes the changed scenario; default: NAME.edited.yaml next to the input",
       [](Session& session, const Command& command) { session.saveScenario(command.text("file"), false); }},
      {"restore",
       {},
       "Shows the view with its edits that was kept when the program did not exit normally",
       [](Session& session, const Command&) {
         if (!session.kept_view_) throw Error(ErrorCode::bad_input, "no edits were kept for this input");
         session.ask(
             {session.options_.view.input, session.options_.view.scenario, session.kept_view_->state, true});
       }},
      {"discard",
       {},
       "Removes what was kept when the program did not exit normally",
       [](Session& session, const Command&) {
         session.panels.restore = false;
         if (!session.kept_view_) throw Error(ErrorCode::bad_input, "no edits were kept for this input");
         session.kept_view_.reset();
         session.has_kept_ = true;
         session.dropKeptView();
       }},
      {"quit",
       {{"edits", kText, false, {}, {"save", "discard", "ask"}}},
       "Ends the program; `edits` that are not saved: save, discard or ask; default: ask, in scripts discard",
       [](Session& session, const Command& command) {
         const bool is_script = !session.options_.script.empty();
         const std::string edits = command.has("edits") ? command.text("edits")
                                   : is_script          ? "discard"
                                                        : "ask";
         session.panels.unsaved = edits == "ask" && session.hasUnsavedEdits();
         if (session.panels.unsaved) return;
         if (edits == "save" && session.hasUnsavedEdits()) {
           session.saveScenario("", true);
         } else {
           session.window_.quit();
         }
       }},
  };
}

}  // namespace emscape::view
