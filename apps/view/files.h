/// What the sessions of a window share: files that are opened one after another, and the recording.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/file_browser.h"
#include "apps/view/recorder.h"
#include "emscape/playback/autosave.h"
#include "emscape/playback/view_state.h"

namespace emscape::view {

/// Asks the window to show something else.
struct OpenRequest {
  std::string file;      ///< input, view file or transfer function
  std::string scenario;  ///< beside volumes; may be empty
  /// How an input is shown; none: as at the start. Edits that do not apply to it any more are left out.
  std::optional<playback::ViewState> view;
  bool unsaved_edits = false;  ///< those of `view` are in no file
};

/// The thread of the window uses it.
struct Files {
  std::vector<std::string> recent;  ///< the newest first
  FileBrowser browser;
  Recorder recorder;
  /// Of this program; kept by jobs that run.
  std::shared_ptr<playback::Autosaves> autosaves = std::make_shared<playback::Autosaves>();
  std::optional<OpenRequest> request;  ///< for the window, which takes it
  bool is_opening = false;             ///< something was asked for that is not on screen yet
};

}  // namespace emscape::view
