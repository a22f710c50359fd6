/// Rows of voxels with reflected rays. Power densities and echoes are in separate source files, because g++
/// does not vectorise the loops of a larger file.
#pragma once

#include "emfield/combine/radar_product.h"
#include "emfield/cpu/row.h"

namespace emscape::emfield {

/// Power densities (W/m2) of an emitter with weighted reflected rays, without the excess.
/// @param reflected  of the row's first voxel
void bothRaysRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected, const Row& row, float* out);

/// Weights of a radar's look with reflected rays; without the excess.
/// @param jammer  whose weights are computed; null: those of the echo
/// @param voxel   index of the row's first voxel
void weightsOfBothRays(const RadarPass& pass, const JammerAtRadar* jammer, std::size_t voxel, const Row& row,
                       float* out);

}  // namespace emscape::emfield
