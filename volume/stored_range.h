/// setStoredRange() of each format. Internal to the module.
#pragma once

#include "emscape/volume/format/file.h"

namespace emscape::volume {

void setVdbRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);
void setNvdbRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);
void setVtiRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);
void setRawRange(const std::filesystem::path& path, const std::vector<StoredRange>& ranges);

/// @throws Error (bad_input) for a quantity that is not in the file
[[noreturn]] void failNoSuchQuantity(const std::filesystem::path& path, const std::string& quantity);

}  // namespace emscape::volume
