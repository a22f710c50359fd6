/// Clutter over rows of voxels; in a separate source file, as are the loops over reflected rays.
#pragma once

#include "emfield/combine/radar_product.h"
#include "emfield/cpu/row.h"

namespace emscape::emfield {

/// Adds a pass's clutter over noise to the jamming of a row.
void addClutter(const RadarPass& pass, const Row& row, float* jamming);

}  // namespace emscape::emfield
