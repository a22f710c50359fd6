/// The command that draws a view into a file.
#pragma once

#include <string>

#include "emscape/playback/frames/shown_field.h"
#include "emscape/playback/view/view_state.h"

namespace emscape::view {

/// `emscape render INPUT --state FILE -o picture.png`.
std::string renderCommand(const playback::ViewState& view, const std::string& state_file);

/// The same with the options that describe the view, and --set for its edits. Colours different from those
/// that `render` would fit are written to a file in stateFolder()/copied.
/// @param shown  the field on screen
/// @throws Error (other) if that file cannot be written
std::string renderCommand(const playback::ViewState& view, const playback::ShownField& shown);

}  // namespace emscape::view
