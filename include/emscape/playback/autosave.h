/// Views that were not saved, kept for the case that their program ends before its time.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "emscape/playback/view_state.h"

namespace emscape {
class FolderLock;
}

namespace emscape::playback {

/// Where programs keep what is to outlive them: $XDG_STATE_HOME/emscape if that is an absolute path, else
/// $HOME/.local/state/emscape. It need not exist. @throws Error (other) if neither variable says where
std::filesystem::path stateFolder();

/// Of an input (scenario, volume, folder), wherever it is called from: its absolute path counts.
/// @param number  1 for the first program that keeps a view of the input, 2 for another one beside it, ...
std::filesystem::path autosaveFileOf(const std::string& input, int number = 1);

/// A view that was kept.
struct AutosavedView {
  std::filesystem::path file;
  std::string written_utc;     ///< when, ISO 8601
  bool input_changed = false;  ///< the input was written after it
  ViewState state;
};

/// The views that one program keeps, one per input. Programs that run at the same time have a file each,
/// locked as long as they run. Any thread.
class Autosaves {
 public:
  Autosaves();
  /// The files stay; their locks go.
  ~Autosaves();
  Autosaves(const Autosaves&) = delete;
  Autosaves& operator=(const Autosaves&) = delete;

  /// Keeps a view with its edits, in place of the one that was kept or found before. The folder is made if
  /// need be. @throws Error (bad_input, other) as writeViewState(), or if no file is free
  void keep(const std::string& input, const ViewState& state);
  /// The view of an input that this program keeps; else the newest one of a program that has ended, which is
  /// this program's from now on. None if there is neither. @throws Error (bad_input) if it cannot be read
  std::optional<AutosavedView> find(const std::string& input);
  /// Removes the view that was kept or found: it was saved, or is not wanted.
  void remove(const std::string& input);

 private:
  struct Claim {
    std::filesystem::path file;
    std::unique_ptr<FolderLock> lock;
  };
  /// Makes a file this program's. @return whether it could be locked
  bool claim(const std::string& input, const std::filesystem::path& file);

  std::mutex mutex_;
  std::map<std::filesystem::path, Claim> claims_;  // by the first file of an input
};

}  // namespace emscape::playback
