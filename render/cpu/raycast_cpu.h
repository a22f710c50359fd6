/// Casts pixels with all threads of the CPU.
#pragma once

#include <vector>

#include "base/progress.h"
#include "render/raycast.h"
#include "render/reconstruction.h"

namespace emscape::render {

/// Casts the pixels of a lattice into an image of task.camera.size; the others are not touched. Tiles run in
/// parallel; each pixel is the same whichever lattice it belongs to.
/// @param nearest  indices: the value of the nearest voxel instead of trilinear interpolation
/// @param stop     set from elsewhere: returns false soon, the lattice unfinished. May be null
bool castCpu(const RaycastTask& task, CompositingMode mode, bool nearest, const Lattice& lattice,
             Image& image, const StopFlag* stop);

/// The same for a list of pixels; those at its front are cast first.
bool castCpu(const RaycastTask& task, CompositingMode mode, bool nearest, const std::vector<Pixel>& pixels,
             Image& image, const StopFlag* stop);

}  // namespace emscape::render
