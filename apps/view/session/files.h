/// State that the sessions of a window share: the files to open and the recording.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/session/file_browser.h"
#include "apps/view/session/recorder.h"
#include "emscape/playback/autosave.h"
#include "emscape/playback/view_state.h"

namespace emscape::view {

/// A request to show something else.
struct OpenRequest {
  std::string file;      ///< input, view file or transfer function
  std::string scenario;  ///< for volumes; may be empty
  /// View of an input; none: that of the start. Edits that do not apply any more are left out.
  std::optional<playback::ViewState> view;
  bool unsaved_edits = false;  ///< the edits of `view` are not saved
};

/// The thread of the window uses it.
struct Files {
  std::vector<std::string> recent;  ///< the newest first
  FileBrowser browser;
  Recorder recorder;
  /// Of this program; shared with running jobs.
  std::shared_ptr<playback::Autosaves> autosaves = std::make_shared<playback::Autosaves>();
  std::optional<OpenRequest> request;  ///< pending, for the window
  bool is_opening = false;             ///< a request is not on screen yet
};

}  // namespace emscape::view
