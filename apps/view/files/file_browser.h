/// Model of a file browser: a folder's content, the selection, and the typed path. No drawing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/worker.h"

namespace emscape::view {

/// Files that the window reads, by their extension: image and places are on the ground.
enum class FileKind {
  folder,
  scenario,
  volume,
  view,
  colors,
  image,
  places,
  places_or_tracks,
  recording,
  other
};
FileKind fileKindOf(const std::filesystem::path& file, bool is_folder);

struct FolderEntry {
  std::string name;
  FileKind kind = FileKind::other;
};

/// The subfolders of a folder, then the files that can be opened, each sorted by name; names that begin with
/// a dot are omitted.
/// @throws Error (other) that names the folder and the cause
std::vector<FolderEntry> listFolder(const std::filesystem::path& folder);

/// Reads folders on a separate thread, because the disk may be slow. For use by the window's thread.
class FileBrowser {
 public:
  /// What a file is chosen for. With the last three it may be new.
  enum class Purpose { input, view, scenario, colors, drape, places, save_scenario, save_colors, record };

  /// Rereads the last visited folder; at first, and after forgetFolder(), the given one.
  /// @param proposed  the typed path at first; may be empty
  void open(Purpose purpose, const std::filesystem::path& first_folder, const std::string& proposed = "");
  const std::string& proposed() const { return proposed_; }
  /// The next dialog begins in the folder of the input, not in the one before.
  void forgetFolder() { begins_anew_ = true; }
  /// True if a typed name may be that of a new file.
  bool savesFile() const { return purpose_ >= Purpose::save_scenario; }
  Purpose purpose() const { return purpose_; }
  void enter(const std::filesystem::path& folder);
  void goUp() { enter(folder_.parent_path()); }
  /// Takes the result of a read. @return true if something changed
  bool update();

  const std::filesystem::path& folder() const { return folder_; }
  bool reading() const { return task_.active(); }
  /// The entries that may be chosen.
  const std::vector<FolderEntry>& entries() const { return entries_; }
  /// Error of reading the folder; empty if there is none.
  const std::string& error() const { return error_; }

  int selected() const { return selected_; }
  void select(int index);
  void moveSelection(int rows) { select(selected_ + rows); }
  /// Opens the selected entry: enters a folder, or returns the file.
  std::optional<std::string> choose();
  /// Opens a typed path, relative to the folder, with ~ for the home, also in quotes: enters a folder, or
  /// returns the file. One that does not exist, or into no folder, is refused.
  std::optional<std::string> choose(const std::string& typed);
  /// The typed path that was refused last.
  const std::string& refused() const { return refused_; }

 private:
  struct Listing {
    std::filesystem::path folder;
    std::vector<FolderEntry> entries;
    std::string error;
  };
  void read();

  Purpose purpose_ = Purpose::input;
  std::string proposed_;
  std::filesystem::path folder_;
  bool begins_anew_ = false;
  std::string left_;  // name of the folder that goUp() left, to be selected
  std::vector<FolderEntry> entries_;
  std::string error_, refused_;
  int selected_ = 0;
  bool again_ = false;  // another folder was requested meanwhile
  AsyncTasks<Listing> task_;
};

}  // namespace emscape::view
