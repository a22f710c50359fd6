/// What emscape-view was started with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/painter.h"
#include "emscape/render/frame_controller.h"
#include "emscape/scenario/edit.h"
#include "emscape/volume/value_range.h"

namespace emscape::view {

struct ViewOptions {
  std::string input;
  std::string scenario;  ///< beside volumes; may be empty
  std::string quantity;
  std::vector<scenario::Edit> edits;
  render::ImageSize window_size{1200, 900};
  double scale = 0;  ///< of texts and controls; 0: that of the screen
  playback::PictureStyle style;
  std::optional<volume::ValueRange> range;
  std::optional<double> time_s;
  render::ControllerOptions controller;
  bool allow_missing_terrain = false;
  std::string script, log;
  std::string backend = "auto";
  int threads = 0;
  bool quiet = false;
};

/// Reads the command line.
/// @return none if help or the version was asked for and printed
/// @throws Error (usage) for wrong options
std::optional<ViewOptions> parseOptions(int argc, char** argv);

}  // namespace emscape::view
