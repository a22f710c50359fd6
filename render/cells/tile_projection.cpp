#include "render/cells/tile_projection.h"

#include <algorithm>

#include "emscape/base/parallel.h"

namespace emscape::render {

TileProjection::TileProjection(const TileTask& task, const CellMesh& mesh,
                               const std::vector<std::int32_t>& order)
    : grid_{task.camera.size}, task_(task), points_(mesh.points.size()), cells_(order.size()) {
  constexpr int kGrain = 4096;
  parallelFor(static_cast<int>(points_.size()), kGrain, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) {
      points_[static_cast<std::size_t>(n)] =
          task.viewOf(mesh.point(n), mesh.values[static_cast<std::size_t>(n)]);
    }
  });
  task_.points = points_.data();
  task_.cells = cells_.data();
  const std::int32_t* const vertices = mesh.view().vertices;
  parallelFor(static_cast<int>(cells_.size()), kGrain, [&](int begin, int end) {
    for (auto rank = static_cast<std::size_t>(begin); rank < static_cast<std::size_t>(end); ++rank)
      cells_[rank] = placed(task_, vertices, order[order.size() - 1 - rank]);
  });
  lists_ = TileLists(grid_, cells_.size(), [this](std::size_t rank) { return cells_[rank].pixels; });
}

long long TileProjection::cells() const {
  return std::count_if(cells_.begin(), cells_.end(),
                       [](const PlacedCell& cell) { return !cell.pixels.isEmpty(); });
}

Image TileProjection::composite() const {
  Image image(grid_.size);
  const LaneTransfer transfer(task_.transfer, task_.psi);
  const LaneTransferView lanes = transfer.view();
  parallelFor(grid_.count(), 1, [&](int begin, int end) {
    for (int tile = begin; tile < end; ++tile) {
      const int* const ranks = lists_.members().data();
      const TileCells cells{grid_.pixelsOf(tile), ranks + lists_.first(tile), ranks + lists_.first(tile + 1)};
      if (task_.psi.values == nullptr) {
        compositeTile(task_, cells, image);
      } else {
        compositeTileInLanes(task_, lanes, cells, image);
      }
    }
  });
  return image;
}

void compositeTile(const TileTask& task, const TileCells& cells, Image& image) {
  const PixelBox& tile = cells.pixels;
  std::vector<PixelRay> rays;
  for (int y = tile.first_y; y < tile.end_y; ++y) {
    for (int x = tile.first_x; x < tile.end_x; ++x) rays.emplace_back(task, x, y);
  }
  std::vector<RayIntegral> integrals(rays.size(), RayIntegral(task.transfer, task.psi));
  for (const int* rank = cells.begin; rank < cells.end; ++rank) {
    const TileCell cell(task, *rank);
    const PixelBox box = common(cell.pixels, tile);
    for (int y = box.first_y; y < box.end_y; ++y) {
      for (int x = box.first_x; x < box.end_x; ++x) {
        const std::size_t pixel = tile.index(x, y);
        addSegment(task, cell, rays[pixel], integrals[pixel]);
      }
    }
  }
  for (int y = tile.first_y; y < tile.end_y; ++y) {
    for (int x = tile.first_x; x < tile.end_x; ++x) image.at(x, y) = integrals[tile.index(x, y)].color();
  }
}

}  // namespace emscape::render
