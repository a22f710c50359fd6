/// Files that grow line by line: journals and logs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/files/descriptor.h"

namespace emscape {

/// A file open for appending; created if it does not exist.
class AppendedFile {
 public:
  /// @throws Error (other) that names the file and the cause; links are refused
  explicit AppendedFile(std::filesystem::path file);

  /// Removes what follows. @throws Error (other)
  void cut(std::uintmax_t bytes);
  /// @throws Error (other); some of the bytes may then be in the file
  void append(const std::string& bytes);
  /// Flushes to the disk. @throws Error (other)
  void sync() const { syncFile(descriptor_, file_); }

 private:
  std::filesystem::path file_;
  Descriptor descriptor_;
};

}  // namespace emscape
