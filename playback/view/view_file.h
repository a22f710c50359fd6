/// View files. The window writes them; `emscape render --state` draws the same picture from them.
#pragma once

#include <string>
#include <vector>

#include "emscape/playback/view/view_state.h"

namespace emscape::playback {

/// Reads a file (docs/view-state.md), JSON or YAML. Missing keys have their default. A relative name of a
/// file to compare with is relative to the file's folder; if there is none, to the working folder.
/// @throws Error (bad_input) that lists all faults with file:line:column
ViewState readViewState(const std::string& file);
/// The same from a text; `file` is the name that errors give. ViewState::compare is as in the text.
ViewState parseViewState(const std::string& text, const std::string& file);

/// The state as JSON; parseViewState() reads it back exactly. A categorical transfer function is left out.
/// Equal states have equal texts.
std::string viewStateText(const ViewState& state);
/// Writes that text, a relative name of a file to compare with made relative to the file's folder; the file
/// is written atomically.
/// @throws Error (bad_input) for a state that cannot be read again, such as a camera outside its limits;
/// (other) if the file cannot be written
void writeViewState(const std::string& file, const ViewState& state);

/// The files of places and of the picture on the ground that do not exist.
std::vector<std::string> missingMapFiles(const ViewState& view);
/// @throws Error (bad_input) that names the first of them that `before` does not have
void requireMapFiles(const ViewState& view, const ViewState& before = {});

}  // namespace emscape::playback
