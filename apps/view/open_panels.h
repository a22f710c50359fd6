/// Which panels of the window are open, and their names.
#pragma once

#include <vector>

namespace emscape::view {

/// Which panels are open.
struct Panels {
  bool scenario = true, colors = false, timeline = true, help = false, time = false, probe = false;
  bool planes = false;
  bool open = false, record = false;      ///< the file browser; what is to be recorded
  bool restore = false, unsaved = false;  ///< questions
  bool changed = false;                   ///< files of the input have changed on the disk
  bool hidden = false;                    ///< all of them, for a moment
};
/// The panels by the names that scripts and view files use, but for `hidden`.
struct PanelName {
  const char* name;
  bool Panels::*open;
  bool stays;  ///< a view keeps it; the others are open for a moment
};
const std::vector<PanelName>& panelNames();

}  // namespace emscape::view
