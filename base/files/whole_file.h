/// Atomic file writes: a file appears under its name only when it is complete.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <vector>

#include "base/files/own_file.h"

namespace emscape {

/// One file to write: `write` fills the stream, which throws on every failure, seeks, and is binary.
struct OutputFile {
  std::filesystem::path path;
  std::function<void(std::ostream&)> write;
};

/// Writes files that belong together: each as an UnfinishedFile, flushed to the disk. When all are complete
/// they are renamed, in the order given. On any failure no final name is written and nothing is left; only a
/// killed process leaves something, which removeAbandonedFiles() recognises.
/// @param replaces  nothing: files of the same name stay, also those that another process writes meanwhile
/// @throws Error (other) that names the path and the cause: missing folder, no permission, no space;
/// exceptions that `write` throws for reasons of its own pass through; (usage) as requireNew() or
/// requireOwn()
void writeWhole(const std::vector<OutputFile>& files, Replaces replaces = Replaces::own);
void writeWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write,
                Replaces replaces = Replaces::own);

/// Protects what a user may have written or edited under the names of outputs.
/// @throws Error (usage) that names the first file that exists, and the option --force
void requireNew(const std::vector<std::filesystem::path>& files);

}  // namespace emscape
