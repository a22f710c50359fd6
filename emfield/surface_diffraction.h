/// The model `diffraction` over a surface on the CPU: most posts of a path are never read.
///
/// Every pixel of a map has a path of its own, but the obstacle that decides is on a few of its posts. Paths
/// of one narrow sector of azimuths lie beside each other: from the heights along its middle and bounds of
/// the slopes follow bounds for all of them (SectorTerrain). These tell which blocks of posts can hold a
/// maximum; only those are read. The losses are those of DiffractionColumn, from the same posts by the same
/// formulas.
#pragma once

#include <vector>

#include "emfield/fill_excess.h"
#include "emfield/terrain_bounds.h"
#include "propagation/diffraction/excess.h"

namespace emscape::emfield {

/// Sets the excess of the columns whose paths need not be read whole.
/// @param bounds  usable
/// @return for each column whether it is left: its excess was not set. Left out are columns without a path
/// (ExcessGrid::isLeftOut, isWithoutGround), near the emitter, not clear of the smooth earth, or whose path
/// is not entirely in one raster without voids; all of them where the surface has few
std::vector<char> fillSurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task,
                                         const TerrainBounds& bounds, const ExcessOutput& out);

}  // namespace emscape::emfield
