/// A small plot of a path's profile, like that of `emscape profile --plot`.
#pragma once

#include <imgui.h>

#include "emscape/emfield/path_budget.h"
#include "emscape/render/annotate/overlay.h"

namespace emscape::view {

/// Ground on the effective earth, the ray over it, its first Fresnel zone, obstacles. Occupies `size` at the
/// cursor.
void drawPathPlot(const emfield::PathBudget& budget, const ImVec2& size, render::Theme theme, float scale);

}  // namespace emscape::view
