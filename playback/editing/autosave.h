/// Autosaves of unsaved views, for recovery after a crash.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "playback/view/view_file.h"

namespace emscape {
class FolderLock;
}

namespace emscape::playback {

/// The folder for persistent state: $XDG_STATE_HOME/emscape if that is an absolute path, else
/// $HOME/.local/state/emscape. It need not exist. @throws Error (other) if neither variable is set
std::filesystem::path stateFolder();

/// The file for an input (scenario, volume, folder), identified by its absolute path.
/// @param number  1 for the first program with a view of the input, 2 for a second one at the same time, ...
std::filesystem::path autosaveFileOf(const std::string& input, int number = 1);

/// A stored view.
struct AutosavedView {
  std::filesystem::path file;
  std::string written_utc;     ///< ISO 8601
  bool input_changed = false;  ///< a file of the input was modified later
  int others = 0;              ///< further stored views of the input, of programs that have ended
  ViewState state;
};

/// The stored views of one program, one per input. Programs that run at the same time have separate files,
/// locked while they run. Any thread may call it.
class Autosaves {
 public:
  Autosaves();
  /// Releases the locks; the files are kept.
  ~Autosaves();
  Autosaves(const Autosaves&) = delete;
  Autosaves& operator=(const Autosaves&) = delete;

  /// Stores a view with its edits; it replaces the one that was stored before or adopted, and none that was
  /// found. Creates the folder if necessary. @throws Error (bad_input, other) as writeViewState(), or if no
  /// file is free
  void keep(const std::string& input, const ViewState& state);
  /// The newest view of an input that this program stored, or that a program that has ended left, which this
  /// program takes over. It stays until it is adopted or discarded. Empty if there is none.
  /// @param sources  the user's files of the input: itself, or those that it was made of
  /// @throws Error (bad_input) if it cannot be read
  std::optional<AutosavedView> find(const std::string& input, const std::vector<std::string>& sources);
  std::optional<AutosavedView> find(const std::string& input) { return find(input, {input}); }
  /// The view that was found is the one that keep() replaces.
  void adopt(const std::string& input);
  /// Removes the view that was found.
  void discard(const std::string& input);
  /// Removes the view that was stored or adopted.
  void remove(const std::string& input);

 private:
  struct Claim {
    std::filesystem::path file;
    std::unique_ptr<FolderLock> lock;
  };
  /// By the first file of an input.
  using Claims = std::map<std::filesystem::path, Claim>;

  /// Takes over a file. @return true if it could be locked
  static bool claim(Claims& claims, const std::string& input, const std::filesystem::path& file);
  static void removeFrom(Claims& claims, const std::string& input);

  std::mutex mutex_;
  Claims stored_, found_;
};

}  // namespace emscape::playback
