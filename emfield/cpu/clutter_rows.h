/// Clutter over rows of voxels, in a source file of its own as the loops over reflected rays are.
#pragma once

#include "emfield/cpu/row.h"
#include "emfield/radar_product.h"

namespace emscape::emfield {

/// Adds a pass's clutter over noise to the jamming of a row.
void addClutter(const RadarPass& pass, const Row& row, float* jamming);

}  // namespace emscape::emfield
