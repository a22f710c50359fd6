/// Rows of voxels with reflected rays. Power densities and echoes have a source file each, apart from those
/// of the other models: g++ leaves loops of a larger file scalar.
#pragma once

#include "emfield/cpu/row.h"
#include "emfield/radar_product.h"

namespace emscape::emfield {

/// Power densities (W/m2) of an emitter whose reflected rays are weighed, without the excess.
/// @param reflected  of the row's first voxel
void bothRaysRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected, const Row& row, float* out);

/// Echoes and jamming of a pass with reflected rays; without the excess.
/// @param voxel    index of the row's first voxel
/// @param root     receives the roots of the echoes' signal-to-noise
/// @param jamming  receives the jamming over noise
void echoesOfBothRays(const RadarPass& pass, std::size_t voxel, const Row& row, float* root, float* jamming);

}  // namespace emscape::emfield
