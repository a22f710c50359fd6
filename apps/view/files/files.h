/// State shared by the sessions of a window: files to open, recording.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/view/files/examples.h"
#include "apps/view/files/file_browser.h"
#include "apps/view/files/message_log.h"
#include "apps/view/files/opening_progress.h"
#include "apps/view/files/recorder.h"
#include "emscape/playback/view/view_state.h"
#include "playback/editing/autosave.h"

namespace emscape::view {

/// A request to show something else.
struct OpenRequest {
  std::string file;      ///< input, view file or transfer function
  std::string scenario;  ///< for volumes; may be empty
  /// View of an input; empty: that of the start. Edits that no longer apply are omitted.
  std::optional<playback::ViewState> view;
  bool unsaved_edits = false;  ///< the edits of `view` are not saved
  bool restores = false;       ///< `view` was kept when the program did not exit normally
};

/// For use by the window's thread.
struct Files {
  std::vector<std::string> recent;  ///< the newest first
  std::vector<Example> examples;
  FileBrowser browser;
  Recorder recorder;
  /// Autosaves of this program; shared with running jobs.
  std::shared_ptr<playback::Autosaves> autosaves = std::make_shared<playback::Autosaves>();
  std::shared_ptr<MessageLog> messages = std::make_shared<MessageLog>();
  std::optional<OpenRequest> request;  ///< pending, for the window
  bool is_opening = false;             ///< a request is not on screen yet
  OpeningProgress opening;             ///< of that request
  bool cancels_opening = false;        ///< for the window, which resets it
  bool is_typing = false;              ///< a text field of the window has the keys
  std::string record_output;           ///< chosen for the next recording; may be empty
  std::set<std::string> pictures;      ///< names that newPictureFile() gave out
};

}  // namespace emscape::view
