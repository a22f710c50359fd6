/// The open panels of the window, and their names.
#pragma once

#include <vector>

namespace emscape::view {

/// The open panels.
struct Panels {
  bool scenario = true, colors = false, timeline = true, help = false, time = false, probe = false;
  bool planes = false;
  bool position = false;                  ///< go to a position
  bool map = false;                       ///< places, picture and range rings on the ground
  bool open = false, record = false;      ///< the file browser; the dialog of recording
  bool restore = false, unsaved = false;  ///< questions
  bool changed = false;                   ///< files of the input have changed on the disk
  bool hidden = false;                    ///< all of them, temporarily
};
/// The panels, except `hidden`, by the names used in scripts and view files.
struct PanelName {
  const char* name;
  bool Panels::*open;
  bool stays;  ///< true: stored in a view; the others are temporary
};
const std::vector<PanelName>& panelNames();

}  // namespace emscape::view
