/// A folder for the files of one test.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace emscape::test {

/// A new, empty folder; it is removed with its contents at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Keeps the folder, for inspection.
  void keep() { is_kept_ = true; }

  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ / name; }
  /// Writes a file of this folder, and makes the folders in its name. @return its path
  std::string write(const std::string& name, const std::string& text) const;
  /// Paths of all files below but lists of outputs, relative to the folder, sorted.
  std::vector<std::string> files() const;

 private:
  std::filesystem::path path_;
  bool is_kept_ = false;
};

}  // namespace emscape::test
