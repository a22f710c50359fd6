// The work of a picture, counted without casting it.
#include "render/patterns/ray_load.h"

#include <gtest/gtest.h>

namespace emscape::render {
namespace {

volume::Grid gridOf(const Dims& dims, const Vec3d& spacing_m) {
  volume::Grid grid;
  grid.dims = dims;
  grid.spacing_m = spacing_m;
  grid.first_center_m = {100, -50, 10};
  return grid;
}

RayLoad loadOf(const volume::Grid& grid, double exaggeration, const std::string& camera, ImageSize size,
               double step_voxels, const std::vector<Lattice>& pixels) {
  const SceneBox box = sceneBoxOf(grid, exaggeration);
  return rayLoadOf(pixels, size, makeCamera(parseCamera(camera), box, size), grid, box, step_voxels);
}

TEST(RayLoad, RayAlongAxisTakesOneSamplePerVoxelOfAnyShape) {
  const ImageSize size{50, 50};
  const std::vector<Lattice> all = sourceLattices(Pattern::full, size);
  const volume::Grid grid = gridOf({8, 6, 10}, {3, 4, 0.5});
  const std::string down = "orbit:elevation_deg=90,projection=orthographic";
  for (const double exaggeration : {1.0, 7.0}) {
    const RayLoad load = loadOf(grid, exaggeration, down, size, 0.3, all);
    EXPECT_GT(load.rays, 1000);
    EXPECT_EQ(load.samples, 34 * load.rays);  // 10 voxels, 0.3 apart
  }
}

TEST(RayLoad, PixelsOutsideTheBoxCostNothing) {
  const ImageSize size{40, 30};
  const RayLoad load =
      loadOf(gridOf({4, 4, 4}, {1, 1, 1}), 1, "orbit:distance=500", size, 1, {Lattice{0, 0, 1, 1, 10, 30}});
  EXPECT_EQ(load.rays, 0);
  EXPECT_EQ(load.samples, 0);
}

TEST(RayLoad, SourceAndMissingPixelsAddUpToWholePicture) {
  const ImageSize size{61, 47};
  const volume::Grid grid = gridOf({20, 30, 10}, {2, 1, 1});
  const RayLoad full = loadOf(grid, 2, "orbit", size, 0.7, sourceLattices(Pattern::full, size));
  for (const Pattern pattern : {Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
    const RayLoad source = loadOf(grid, 2, "orbit", size, 0.7, sourceLattices(pattern, size));
    const RayLoad missing = loadOf(grid, 2, "orbit", size, 0.7, missingLattices(pattern, size));
    EXPECT_EQ(source.rays + missing.rays, full.rays) << toString(pattern);
    EXPECT_EQ(source.samples + missing.samples, full.samples) << toString(pattern);
    EXPECT_NEAR(static_cast<double>(source.rays) / static_cast<double>(full.rays),
                pattern == Pattern::quarter ? 0.25 : 0.5, 0.02);
  }
}

}  // namespace
}  // namespace emscape::render
