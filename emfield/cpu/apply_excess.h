/// The excess of a row on the CPU, in vector instructions.
#pragma once

#include "emfield/columns/excess_code.h"

namespace emscape::emfield {

/// Multiplies the values of a row by the factors of its excess.
/// @param excess  empty: 1
/// @param first   index of the row's first voxel
void applyExcess(const ExcessView& excess, std::size_t first, int count, float* row);

}  // namespace emscape::emfield
