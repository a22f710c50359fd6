/// Making of output folders.
#pragma once

#include <filesystem>

namespace emscape {

/// The first part of a path that exists and is no folder; empty: there is none.
std::filesystem::path fileInPath(const std::filesystem::path& path);

/// @throws Error (usage) if a part of a folder's path is a file
void requireNoFileIn(const std::filesystem::path& folder);

/// Makes a folder and its parents, as far as they do not exist. Links are followed: the user names the
/// folder.
/// @throws Error (other) that names the folder and the cause
void makeFolder(const std::filesystem::path& folder);

/// A folder that is made if it is missing, and then removed in the end if no file has come into it.
class FolderForFiles {
 public:
  /// @throws Error as makeFolder()
  explicit FolderForFiles(std::filesystem::path folder);
  ~FolderForFiles();
  FolderForFiles(const FolderForFiles&) = delete;
  FolderForFiles& operator=(const FolderForFiles&) = delete;

 private:
  std::filesystem::path folder_;
  bool is_new_;
};

/// Makes FOLDER/INNER. No component of INNER may be a symbolic link: it would lead the program's files to
/// where the user did not send them.
/// @return FOLDER/INNER
/// @throws Error (other) that names the folder and the cause
std::filesystem::path makeFolderIn(const std::filesystem::path& folder, const std::filesystem::path& inner);

}  // namespace emscape
