/// The profile of a path as a small plot, as `emscape profile --plot` draws it.
#pragma once

#include <imgui.h>

#include "emscape/emfield/path_budget.h"
#include "emscape/render/annotate/overlay.h"

namespace emscape::view {

/// Ground on the effective earth, the ray over it, its first Fresnel zone, obstacles. Takes `size` of the
/// window at its cursor.
void drawPathPlot(const emfield::PathBudget& budget, const ImVec2& size, render::Theme theme, float scale);

}  // namespace emscape::view
