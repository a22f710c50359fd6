/// Options of emscape-view.
#pragma once

#include <optional>
#include <string>

#include "emscape/playback/pictures/painter.h"
#include "emscape/render/patterns/frame_controller.h"
#include "playback/editing/view_state.h"

namespace emscape::view {

struct ViewOptions {
  std::string input;     ///< empty: the window asks for one
  std::string scenario;  ///< for volumes; may be empty
  std::string mesh;      ///< mesh of a scenario's field (FrameSelection::mesh); empty: a grid
  playback::CellStyle cells;
  playback::ViewState view;      ///< initial view; `size` is the size of the picture
  std::string state;             ///< file that `view` was read from; empty: none, or options changed it
  std::string transfer;          ///< file of the transfer function; may be empty
  bool unsaved_edits = false;    ///< the edits of `view` are not saved: they are from an autosave
  bool offers_kept_view = true;  ///< asks whether the autosave of the input is to be restored
  /// Empty: as large as the view's picture requires.
  std::optional<render::ImageSize> window_size = render::ImageSize{1200, 900};
  double scale = 0;  ///< of text and controls; 0: the screen's scale
  render::ControllerOptions controller;
  bool allow_missing_terrain = false;
  std::string script, log;
  bool share_gpu =
      true;  ///< busy pictures are passed from CUDA to OpenGL on the GPU if both use the same one
  std::string backend = "auto";
  int threads = 0;
  bool quiet = false;
};

/// Reads the command line.
/// @return empty if help or the version was requested and printed
/// @throws Error (usage) for invalid options
std::optional<ViewOptions> parseOptions(int argc, char** argv);

}  // namespace emscape::view
