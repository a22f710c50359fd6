/// Number of rays and samples of a picture without early termination and skipping.
#pragma once

#include <vector>

#include "emscape/render/scene/camera.h"
#include "emscape/volume/grid.h"
#include "render/patterns/reconstruction.h"

namespace emscape::render {

/// Load of a set of pixels.
struct RayLoad {
  long long rays = 0;     ///< pixels whose ray crosses the volume's box
  long long samples = 0;  ///< positions at which these rays are sampled from one face of the box to another:
                          ///< without early termination, without skipping, without ground
};

/// @param box          of `grid` as drawn, see sceneBoxOf()
/// @param step_voxels  > 0
RayLoad rayLoadOf(const std::vector<Lattice>& pixels, ImageSize size, const Camera& camera,
                  const volume::Grid& grid, const SceneBox& box, double step_voxels);

}  // namespace emscape::render
