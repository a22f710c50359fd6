/// Reading of SIMDIS' ASCII scenarios (.asi).
#pragma once

#include <string_view>

#include "recording/common/byte_source.h"
#include "recording/common/read_options.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// True if the begin of a file is that of such a scenario.
bool isAsi(std::string_view head);

/// Reads platforms (in latitude, longitude and height, or ECEF) and beams: switching, directions relative to
/// the body or to true north, targets.
/// @see SIMDIS User Manual, ASCII Scenario Input; SIMDIS SDK, examples
/// @throws Error (bad_input) if there are too many objects or positions
Recording readAsi(ByteSource& source, const ReadOptions& options);

}  // namespace emscape::interop
