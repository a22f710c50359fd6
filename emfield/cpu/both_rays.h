/// Rows of voxels with reflected rays. Power densities and echoes have a source file each, apart from those
/// of the other models: g++ leaves loops of a larger file scalar.
#pragma once

#include "emfield/cpu/row.h"
#include "emfield/radar_product.h"

namespace emscape::emfield {

/// Power densities (W/m2) of an emitter whose reflected rays are weighed, without the excess.
/// @param reflected  of the row's first voxel
void bothRaysRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected, const Row& row, float* out);

/// Weights of a radar's look with reflected rays; without the excess.
/// @param jammer  of which they are; null: of the echo
/// @param voxel   index of the row's first voxel
void weightsOfBothRays(const RadarPass& pass, const JammerAtRadar* jammer, std::size_t voxel, const Row& row,
                       float* out);

}  // namespace emscape::emfield
