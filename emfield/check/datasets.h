/// The datasets' functions, one file a family; the table in reference_check.cpp names them.
#pragma once

#include <filesystem>

#include "emfield/check/reference_check.h"

namespace emscape::emfield {

// check_geoid.cpp
DatasetCheck checkGeoid(const std::filesystem::path& folder);

}  // namespace emscape::emfield
