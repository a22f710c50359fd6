/// The value of --range.
#pragma once

#include <string>

#include "emscape/playback/frames/field_series.h"

namespace emscape::app {

/// Parses "MIN:MAX", MIN < MAX. @throws Error (usage)
playback::ValueRange parseRange(const std::string& text);

}  // namespace emscape::app
