/// A small plot of a path's profile, as by `emscape profile --plot`.
#pragma once

#include <imgui.h>

#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/render/annotate/overlay.h"

namespace emscape::view {

/// Draws the ground on the effective earth, the ray above it, its first Fresnel zone, and obstacles. Occupies
/// `size` at the cursor.
void drawPathPlot(const emfield::PathBudget& budget, const ImVec2& size, render::Theme theme, Units units,
                  float scale);

}  // namespace emscape::view
