/// The open panels of the window, and their names.
#pragma once

#include <vector>

namespace emscape::view {

/// The open panels.
struct Panels {
  bool scenario = true, colors = false, timeline = true, help = false, time = false, probe = false;
  bool planes = false;
  bool open = false, record = false;                       ///< the file browser; the dialog of recording
  bool restore = false, unsaved = false, replace = false;  ///< questions
  bool warnings = false;
  bool position = false;  ///< go to a position
  bool map = false;       ///< places, picture and range rings on the ground
  bool menu = false;      ///< of the selection
  bool side = false;      ///< the side panel lies over the picture, in a window too narrow for both
  bool changed = false;   ///< files of the input have changed on the disk
  bool hidden = false;    ///< all of them, temporarily
};
/// What a panel takes from the rest of the window.
enum class PanelKind {
  docked,    ///< its room; stored in a view, while the others are temporary
  beside,    ///< nothing
  dialog,    ///< the keys without Ctrl
  question,  ///< all keys: the window waits for it
};
/// The panels, except `hidden`, by the names used in scripts and view files.
struct PanelName {
  const char* name;
  bool Panels::*open;
  PanelKind kind;

  bool stays() const { return kind == PanelKind::docked; }
};
const std::vector<PanelName>& panelNames();
/// True if a panel of a kind is open.
bool isOpen(const Panels& panels, PanelKind kind);
/// True if a dialog or a question has the keys.
bool isDialogOpen(const Panels& panels);

}  // namespace emscape::view
