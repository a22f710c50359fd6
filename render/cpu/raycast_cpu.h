/// Casts pixels with all threads of the CPU.
#pragma once

#include <vector>

#include "emscape/base/progress.h"
#include "emscape/render/scene/render_settings.h"
#include "render/cast/raycast.h"
#include "render/patterns/reconstruction.h"
#include "render/scene/ground_layer.h"

namespace emscape::render {

/// Inputs of a cast.
struct CpuCast {
  const RaycastTask& task;
  CompositingMode mode = CompositingMode::dvr;
  bool nearest = false;  ///< indices: the value of the nearest voxel instead of trilinear interpolation
  bool plain = false;    ///< the scalar form instead of packets, for comparison
  GroundLayer* ground = nullptr;  ///< of the picture's size; unknown pixels are filled when they are cast
  bool shows_ground = true;       ///< false: pixels show only the volume, ended by the ground
};

/// Casts the pixels of a lattice into an image of task.camera.size; other pixels are not changed. Tiles run
/// in parallel; a pixel does not depend on the lattice or list to which it belongs.
/// @param stop     set by another thread: returns false soon, with the lattice unfinished. May be null
/// @param samples  is increased by the number of samples
bool castCpu(const CpuCast& cast, const Lattice& lattice, Image& image, const StopFlag* stop,
             long long& samples);
/// The same for a list of pixels; those at its front are cast first.
bool castCpu(const CpuCast& cast, const std::vector<Pixel>& pixels, Image& image, const StopFlag* stop,
             long long& samples);
/// Casts pixels of a picture again, each by kEdgeRays rays, and replaces them by the means. A stopped cast
/// changes no pixel.
bool castEdges(const CpuCast& cast, const std::vector<Pixel>& pixels, Image& image, const StopFlag* stop,
               long long& samples);
/// Puts the ground behind the pixels of an image that shows only the volume. All of the ground must be known.
void composeGround(const CpuCast& cast, const Image& volume, Image& picture);

}  // namespace emscape::render
