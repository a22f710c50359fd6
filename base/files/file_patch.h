/// Changes of bytes within existing files.
#pragma once

#include <filesystem>
#include <vector>

#include "base/files/file_digest.h"

namespace emscape {

/// Overwrites parts of a file of this program in place, which isOwn() again; they are on the disk at return.
/// Not atomic: after a crash of the machine some of the patches may be unwritten. The record is of the
/// patched file from before the first patch on: of a killed process both the former and the new file are
/// known, the one by its maker's journal.
/// @throws Error (other); links are refused
void patchFile(const std::filesystem::path& path, const std::vector<FilePatch>& patches);

}  // namespace emscape
