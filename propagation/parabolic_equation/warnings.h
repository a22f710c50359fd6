/// Warnings of `parabolic_equation`: what its march loses over steep ground, and what holds it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "propagation/parabolic_equation/excess.h"
#include "propagation/parabolic_equation/plan.h"

namespace emscape::propagation {

/// Warning bits of a fraction in thousandths.
unsigned partWarning(double part, int shift);

/// Warning bits of ground that the band does not hold, and of the least largest angle that holds most of what
/// any angle does.
/// @param staircase_part  staircasePart() of the march's ground with a grid
unsigned staircaseWarning(const MarchGrid& grid,
                          const std::function<double(const MarchGrid& grid)>& staircase_part);
/// Of all azimuths that are marched.
unsigned staircaseWarning(const PePlan& plan, const AzimuthMarch& march);

std::vector<std::string> peWarningMessages(unsigned warnings);

}  // namespace emscape::propagation
