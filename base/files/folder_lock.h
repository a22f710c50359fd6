/// Locks of output folders.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/files/descriptor.h"

namespace emscape {

/// The exclusive right to write a folder's files, held until destruction by one process at a time; the kernel
/// takes it back from a process that dies.
class FolderLock {
 public:
  /// Creates FOLDER/NAME, which names the holder of the lock and is removed with it. A file of that name that
  /// is no lock of this program is neither changed nor removed; an empty one that nobody has locked is used,
  /// and left empty.
  /// @throws Error (other) that names the process that holds it, or the cause of another failure
  FolderLock(const std::filesystem::path& folder, const std::string& name);
  /// The same, but null if another process holds the lock.
  static std::unique_ptr<FolderLock> tryLock(const std::filesystem::path& folder, const std::string& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(std::filesystem::path file);
  /// @return false if another process holds the lock, named in `holder`
  bool lock(std::string& holder);
  void remove();

  std::filesystem::path file_;
  Descriptor folder_, descriptor_;
  bool was_empty_ = false;  ///< the file was there before, empty: it stays
};

}  // namespace emscape
