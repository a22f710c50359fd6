/// Inputs of models that march outwards: the positions of the field, and the ground around the emitter.
#pragma once

#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/inputs.h"
#include "propagation/radial.h"

namespace emscape::emfield {

/// @param terrain  null: a smooth earth at mean sea level; must outlive the result
/// @param extent   pathExtent() of the columns
/// @throws Error (bad_input) if the ground below the station is missing
propagation::RadialInputs radialInputs(const Station& station, const GridColumns& columns,
                                       const scenario::Terrain* terrain,
                                       const propagation::PathExtent& extent);

}  // namespace emscape::emfield
