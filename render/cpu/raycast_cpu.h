/// Casts pixels with all threads of the CPU.
#pragma once

#include <vector>

#include "emscape/base/progress.h"
#include "emscape/render/render_settings.h"
#include "render/ground_layer.h"
#include "render/raycast.h"
#include "render/reconstruction.h"

namespace emscape::render {

/// What is cast, and how.
struct CpuCast {
  const RaycastTask& task;
  CompositingMode mode = CompositingMode::dvr;
  bool nearest = false;  ///< indices: the value of the nearest voxel instead of trilinear interpolation
  bool plain = false;    ///< the plain form instead of packets, for comparison
  GroundLayer* ground = nullptr;  ///< of the picture's size; its unknown pixels are filled as they are cast
  bool shows_ground = true;       ///< false: pixels show the volume alone, cut off where the ground is
};

/// Casts the pixels of a lattice into an image of task.camera.size; the others are not touched. Tiles run in
/// parallel; each pixel is the same whichever lattice or list it belongs to.
/// @param stop     set from elsewhere: returns false soon, the lattice unfinished. May be null
/// @param samples  is increased by the samples that were taken
bool castCpu(const CpuCast& cast, const Lattice& lattice, Image& image, const StopFlag* stop,
             long long& samples);
/// The same for a list of pixels; those at its front are cast first.
bool castCpu(const CpuCast& cast, const std::vector<Pixel>& pixels, Image& image, const StopFlag* stop,
             long long& samples);

}  // namespace emscape::render
