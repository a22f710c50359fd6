/// Passes of radars whose look has arcs.
#pragma once

#include "emfield/combine/radar_product.h"

namespace emscape::emfield {

/// Runs a pass whose look has arcs, voxel by voxel (addEcho). In a file of its own: in radar_product_cpu.cpp
/// the loop over arcs would keep the compiler from using SIMD for the rows.
void radarOfArcsCpu(const RadarPass& pass);

}  // namespace emscape::emfield
