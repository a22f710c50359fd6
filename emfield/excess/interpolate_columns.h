/// The excess of columns that are not computed, from those around them.
#pragma once

#include "emfield/excess/fill_excess.h"

namespace emscape::emfield {

/// Fills the columns of a grid that ExcessGrid::part does not contain: excess in decibels and shadow edges,
/// bilinear between the columns of the part. A column of the part has in layers below its ground the excess
/// of its lowest layer above it. Where one of two columns is unknown, and at edges without limit, the value
/// is that of the nearer one.
/// @param out  with codes, and without reflected rays and mechanisms, which are not interpolated
void interpolateColumnsCpu(const ExcessGrid& grid, const ExcessOutput& out);

}  // namespace emscape::emfield
