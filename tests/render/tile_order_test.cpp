/// The order in which a GPU's launches cast tiles; needs no GPU.
#include "render/cuda/tile_order.h"

#include <gtest/gtest.h>

#include <vector>

namespace emscape::render::cuda {
namespace {

RaycastTask lookingAtABox(ImageSize size) {
  RaycastTask task;
  task.volume.dims = {40, 40, 20};
  task.camera.eye = {20, -60, 45};
  task.camera.forward = {0, 0.8, -0.4};
  task.camera.right = {1, 0, 0};
  task.camera.up = {0, 0.4, 0.8};
  task.camera.half_height = 0.4;
  task.camera.size = size;
  return task;
}

const ImageSize kSizes[] = {{1, 1}, {31, 7}, {200, 150}, {1201, 899}};

TEST(TileOrder, HasEveryPixelOfALatticeOnce) {
  for (const ImageSize size : kSizes) {
    for (const Pattern pattern : {Pattern::full, Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
      std::vector<int> cast(static_cast<std::size_t>(size.count()));
      long long beyond = 0;
      for (const Lattice& lattice : sourceLattices(pattern, size)) {
        const TileOrder order = longestFirst(lookingAtABox(size), lattice);
        for (unsigned tile = 0; tile < order.allTiles(); ++tile) {
          for (unsigned lane = 0; lane < 32; ++lane) {
            Pixel pixel;
            if (order.pixelOf(tile, lane, pixel)) {
              ++cast[static_cast<std::size_t>(pixel.y) * size.width + pixel.x];
            } else {
              ++beyond;
            }
          }
        }
      }
      long long rays = 0;
      for (const int times : cast) {
        ASSERT_LE(times, 1);
        rays += times;
      }
      EXPECT_EQ(rays, pixelCount(sourceLattices(pattern, size)));
      EXPECT_GE(beyond, 0);
    }
  }
}

TEST(TileOrder, BeginsWithTheLongestRays) {
  const ImageSize size{1200, 900};
  const RaycastTask task = lookingAtABox(size);
  const TileOrder order = longestFirst(task, sourceLattices(Pattern::quarter, size).front());
  ASSERT_GT(order.shown_cells, 0);
  ASSERT_LT(order.shown_cells, TileOrder::kCells);
  // The middle of each cell; cells are about as long as their middle, give or take what a cell spans.
  const auto lengthOf = [&](int n) {
    Pixel pixel;
    const unsigned middle = order.tilesOfCell() / 2;
    return order.pixelOf(static_cast<unsigned>(n) * order.tilesOfCell() + middle, 0, pixel)
               ? task.segmentsOf(pixel.x, pixel.y, {}).length
               : 0.0F;
  };
  double first_half = 0, second_half = 0;
  for (int n = 0; n < order.shown_cells; ++n) {
    (n < order.shown_cells / 2 ? first_half : second_half) += lengthOf(n);
  }
  EXPECT_GT(first_half, 1.5 * second_half);
  for (int n = order.shown_cells; n < TileOrder::kCells; ++n) EXPECT_EQ(lengthOf(n), 0.0F) << n;
}

TEST(TileOrder, ShowsNothingWhereNoRayMeetsTheVolume) {
  const ImageSize size{64, 64};
  RaycastTask task = lookingAtABox(size);
  task.camera.forward = {0, -0.8, 0.4};
  EXPECT_EQ(longestFirst(task, sourceLattices(Pattern::full, size).front()).shownTiles(), 0U);
}

}  // namespace
}  // namespace emscape::render::cuda
