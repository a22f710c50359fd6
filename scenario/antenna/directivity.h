/// The integral of an antenna's pattern over the sphere.
#pragma once

#include "emscape/scenario/antenna/antenna.h"

namespace emscape::scenario {

/// Integral (sr) of the pattern's relative power, unsteered, over the sphere: 4 pi for the isotropic one.
double patternIntegral_sr(const PatternView& pattern);

}  // namespace emscape::scenario
