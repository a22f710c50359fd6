/// Options of emscape-view.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/view/files/recordings.h"
#include "emscape/playback/view/view_state.h"
#include "playback/stream/live_battlefield.h"
#include "render/patterns/frame_controller.h"

namespace emscape::view {

struct ViewOptions {
  /// The first view; `size` is the size of the picture. Without an input the window asks for one.
  playback::ViewState view;
  std::string state;           ///< file that `view` was read from; empty: none, or options changed it
  bool unsaved_edits = false;  ///< the edits of `view` are not saved: they are from an autosave
  /// The picture's texts are as large as those of the panels; false: as the view says.
  bool fits_labels = true;
  bool offers_kept_view = true;  ///< asks whether the autosave of the input is to be restored
  /// Empty: as large as the view's picture requires.
  std::optional<render::ImageSize> window_size = render::ImageSize{1200, 900};
  /// The size is that at scale 1: a larger scale has a larger window, as large as the screen at most.
  bool scales_window = true;
  double scale = 0;  ///< of text and controls; 0: the screen's scale
  render::ControllerOptions controller;
  /// A battlefield that another program streams, of which `view` shows the scenario; null: none.
  std::shared_ptr<playback::LiveBattlefield> stream;
  std::optional<playback::StreamRequest> stream_request;  ///< of the command line
  /// The user's file of which the program has made the input: the base of a stream, a recording; else empty.
  std::string made_of;
  ImportNote made_note;
  /// The file whose name and folder those of outputs follow.
  const std::string& namesake() const { return made_of.empty() ? view.input : made_of; }
  std::string script, log;
  bool share_gpu =
      true;  ///< busy pictures are passed from CUDA to OpenGL on the GPU if both use the same one
  std::string backend = "auto";
  int devices = 1;  ///< 0: all
  int threads = 0;
  bool quiet = false;
};

/// Reads the command line.
/// @return empty if help or the version was requested and printed
/// @throws Error (usage) for invalid options
std::optional<ViewOptions> parseOptions(int argc, char** argv);

}  // namespace emscape::view
