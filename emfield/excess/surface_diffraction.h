/// The model `diffraction` over a surface on the CPU: most posts of a path are never read.
///
/// Every pixel of a map has its own path, but the dominant obstacle is at a few of its posts. Paths of one
/// narrow sector of azimuths are close to each other: heights along its middle and bounds of the slopes give
/// bounds for all of them (SectorTerrain). Only blocks of posts that may contain a maximum according to these
/// bounds are read, of sixteen paths at a time, each in a vector lane. The losses equal those of
/// DiffractionExcess: the same posts and formulas.
#pragma once

#include <vector>

#include "emfield/excess/fill_excess.h"
#include "emfield/ground/terrain_bounds.h"
#include "propagation/diffraction/excess.h"

namespace emscape::emfield {

/// Sets the excess of the columns whose paths need not be read whole.
/// @param bounds  usable
/// @return for each column, true if its excess was not set: columns without a path (ExcessGrid::isLeftOut,
/// isWithoutGround), near the emitter, not clear of the smooth earth, or whose path is not entirely in one
/// raster without voids; all columns of small surfaces
std::vector<char> fillSurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task,
                                         const TerrainBounds& bounds, const ExcessOutput& out);

}  // namespace emscape::emfield
