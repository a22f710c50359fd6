/// Passes of radars whose look has arcs.
#pragma once

#include "emfield/radar_product.h"

namespace emscape::emfield {

/// As radarCpu(), voxel by voxel: the loop over the arcs of a look does not fit into the loops over rows, nor
/// into their source file, where it would keep the compiler from using SIMD.
void radarOfArcsCpu(const RadarPass& pass);

}  // namespace emscape::emfield
