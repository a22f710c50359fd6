/// Types of recorded objects in words.
#pragma once

#include <string>

#include "recording/common/recording.h"

namespace emscape::interop {

/// "air platform (1.2.0.0.0.0.0)", "air, unknown side (a-u-A)"; types that are words stay as they are.
std::string typeText(const RecordedObject& object);

}  // namespace emscape::interop
