/// The view as a whole: its file, its picture, the command that draws it.
#include <filesystem>
#include <utility>

#include "apps/view/files/file_endings.h"
#include "apps/view/files/picture_files.h"
#include "apps/view/parts/render_command.h"
#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "playback/view/view_file.h"

namespace emscape::view {
namespace {

/// The view without values that do not change the picture.
std::string pictureText(playback::ViewState view) {
  view.bookmarks.clear();
  view.open_panels.clear();
  view.rate = 1;
  view.loop = false;
  view.play_range.reset();
  view.visible_time.reset();
  return playback::viewStateText(view);
}

}  // namespace

std::string besideInput(const std::string& input, const std::string& ending) {
  const std::filesystem::path path = std::filesystem::path(input).lexically_normal();
  const std::filesystem::path named = path.has_filename() ? path : path.parent_path();
  return (named.parent_path() / (named.stem().string() + ending)).string();
}

playback::ViewState Session::viewState() const {
  playback::ViewState view = view_;
  view.bookmarks.clear();
  for (const auto& bookmark : bookmarks_) {
    if (bookmark) view.bookmarks.push_back(*bookmark);
  }
  view.rate = timeline_.rate();
  view.loop = timeline_.loop();
  if (!timeline_.times_s().empty()) {
    view.play_range = timeline_.playPart();
    view.visible_time = timeline_.visiblePart();
  }
  if (view.size.count() == 0) view.size = options_.view.size;
  view.open_panels.clear();
  if (panels.hidden) view.open_panels.emplace_back("hidden");
  for (const PanelName& panel : panelNames()) {
    if (panel.stays() && panels.*panel.open) view.open_panels.emplace_back(panel.name);
  }
  return view;
}

/// Applies the parts of a view that have their own state.
void Session::showView(const playback::ViewState& view) {
  camera_.set(view.camera);
  std::size_t next = 0;
  for (const playback::Bookmark& bookmark : view.bookmarks) {
    const bool is_number = bookmark.name.size() == 1 && bookmark.name[0] >= '1' && bookmark.name[0] <= '9';
    if (is_number) {
      bookmarks_[static_cast<std::size_t>(bookmark.name[0] - '1')] = bookmark;
      continue;
    }
    while (next < bookmarks_.size() && bookmarks_[next]) ++next;
    if (next < bookmarks_.size()) bookmarks_[next] = bookmark;
  }
  timeline_.setRate(view.rate);
  timeline_.setLoop(view.loop);
  if (view.settings.mode != render::CompositingMode::iso) fog_mode_ = view.settings.mode;
  if (view.open_panels.empty()) return;  // a picture's view has no panels
  panels = Panels{};
  for (const PanelName& panel : panelNames()) panels.*panel.open = false;
  for (const std::string& name : view.open_panels) {
    if (name == "hidden") panels.hidden = true;
    for (const PanelName& panel : panelNames()) {
      if (panel.stays() && name == panel.name) panels.*panel.open = true;
    }
  }
}

void Session::noteSavedView(const std::string& file) {
  saved_file_ = file;
  playback::ViewState view = viewState();
  if (file == options_.state) view.size = options_.view.size;  // the window's size may differ from the file's
  saved_text_ = pictureText(view);
}

void Session::saveView(const std::string& file) {
  jobs_.run([this, file, view = viewState()]() -> BackgroundJobs::Finish {
    playback::writeViewState(file, view);
    return [this, file, text = pictureText(view), colors = view.transfer] {
      saved_file_ = file;
      saved_text_ = text;
      if (transfer_ && colors) saved_colors_ = colors;
      tellWritten(file);
    };
  });
}

void Session::copyCommand() {
  if (!picture_) throw Error(ErrorCode::bad_input, "there is no picture yet");
  const auto copy = [this](const std::string& text) {
    window_.setClipboard(text);
    copied_ = text;
    tell("copied: " + text);
  };
  const playback::ViewState view = viewState();
  if (!saved_file_.empty() && pictureText(view) == saved_text_) {
    return copy(renderCommand(view, saved_file_));
  }
  jobs_.run([copy, view, picture = picture_]() -> BackgroundJobs::Finish {
    const std::string text = renderCommand(view, *picture);
    return [copy, text] { copy(text); };
  });
}

void Session::writePendingPicture() {
  if (picture_file_.empty() || !isPictureSettled()) return;
  jobs_.run([this, file = std::exchange(picture_file_, ""), picture = picture_]() -> BackgroundJobs::Finish {
    render::writePng(file, picture->finished);
    return [this, file] { tellWritten(file); };
  });
}

std::vector<Verb> Session::stateVerbs() {
  return {
      {"save_state",
       {{"file", kText, false, {}, {}, requireJsonEnding}, {"replace", kBoolean, false}},
       "Writes the view: camera, colours, time, edits and the rest; default: NAME.view.json next to the "
       "input",
       [](Session& session, const Command& command) {
         session.requireInput();
         const std::string given = command.text("file");
         const std::string file =
             given.empty() ? besideInput(session.options_.namesake(), ".view.json") : given;
         if (!session.asksToReplace(command, file)) session.saveView(file);
       }},
      {"load_state",
       {{"file", kText, false}},
       "Shows the view of a file; without one: asks for it",
       [](Session& session, const Command& command) {
         if (command.has("file")) {
           session.ask({command.text("file"), "", std::nullopt, false});
         } else {
           session.browse(FileBrowser::Purpose::view);
         }
       }},
      {"picture",
       {{"file", kText, false, {}, {}, requirePictureEnding}, {"replace", kBoolean, false}},
       "Writes the picture without panels, as `emscape render` draws it, as soon as it is exact; default: a "
       "new emscape-NNNN.png, where `screenshot` writes it",
       [](Session& session, const Command& command) {
         session.requireInput();
         const std::string given = command.text("file");
         const std::string file =
             given.empty() ? newPictureFile(session.options_.namesake(), session.files_->pictures) : given;
         if (!session.asksToReplace(command, file)) session.picture_file_ = file;
       }},
      {"copy_command",
       {},
       "Puts the command that draws this picture on the clipboard",
       [](Session& session, const Command&) { session.copyCommand(); }},
  };
}

}  // namespace emscape::view
