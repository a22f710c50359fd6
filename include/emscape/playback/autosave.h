/// Views that were not saved, kept for the case that their program ends before its time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "emscape/playback/view_state.h"

namespace emscape::playback {

/// Where programs keep what is to outlive them: $XDG_STATE_HOME/emscape if that is an absolute path, else
/// $HOME/.local/state/emscape. It need not exist. @throws Error (other) if neither variable says where
std::filesystem::path stateFolder();

/// Of an input (scenario, volume, folder), wherever it is called from: its absolute path counts.
std::filesystem::path autosaveFileOf(const std::string& input);

/// A view that was kept.
struct AutosavedView {
  std::filesystem::path file;
  std::string written_utc;     ///< when, ISO 8601
  bool input_changed = false;  ///< the input was written after it
  ViewState state;
};

/// Keeps a view with its edits; one that was kept before is replaced. The folder is made if need be.
/// @throws Error (bad_input, other) as writeViewState()
void autosave(const std::string& input, const ViewState& state);
/// What is kept for an input; none if nothing is. @throws Error (bad_input) if it cannot be read
std::optional<AutosavedView> findAutosave(const std::string& input);
/// Removes what is kept for an input: it was saved, or is not wanted.
void removeAutosave(const std::string& input);

}  // namespace emscape::playback
