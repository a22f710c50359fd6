/// Picture of a path's loss over range and height, with the refractivity profile next to it.
#pragma once

#include <string>

#include "emfield/link/path_section.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/render/picture/image.h"

namespace emscape::report {

/// The file is written atomically.
/// @throws Error (other) naming the file
void plotSection(const emfield::PathBudget& budget, const emfield::PathSection& section,
                 render::ImageSize size, const std::string& file);

}  // namespace emscape::report
