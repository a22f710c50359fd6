/// How the samples of a ray become a pixel: one small functor a mode, plain data for host and device.
#pragma once

#include <string>

#include "base/host_device.h"
#include "render/image.h"

namespace emscape::render {

enum class CompositingMode { dvr, mida, mip };
const char* toString(CompositingMode mode);
/// @throws Error (usage) that lists the names
CompositingMode parseCompositingMode(const std::string& name);

}  // namespace emscape::render
