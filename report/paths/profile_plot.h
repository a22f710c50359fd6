/// Picture of a path: terrain on the effective earth, the ray above it, its first Fresnel zone, obstacles.
#pragma once

#include <string>

#include "emscape/emfield/link/path_budget.h"
#include "emscape/render/picture/image.h"

namespace emscape::report {

/// Heights are drawn over the effective earth, so that the ray is straight and sea level curves. The file is
/// written atomically.
/// @throws Error (other) naming the file
void plotProfile(const emfield::PathBudget& budget, render::ImageSize size, const std::string& file);

}  // namespace emscape::report
