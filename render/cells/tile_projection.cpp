#include "render/cells/tile_projection.h"

#include <algorithm>

#include "emscape/base/parallel.h"

namespace emscape::render {

TileProjection::TileProjection(const TileTask& task, const CellMesh& mesh,
                               const std::vector<std::int32_t>& order, bool sort_rays)
    : grid_{task.camera.size},
      task_(task),
      sort_rays_(sort_rays),
      points_(mesh.points.size()),
      cells_(order.size()) {
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
      const TileCells cells{grid_.pixelsOf(tile), ranks + lists_.first(tile), ranks + lists_.first(tile + 1),
                            sort_rays_};
      if (task_.psi.values == nullptr) {
        compositeTile(task_, cells, image);
      } else {
        compositeTileInLanes(task_, lanes, cells, image);
      }
    }
  });
  return image;
}

void compositeSorted(const TileTask& task, const TileCells& cells, int x, int y, RayIntegral& integral) {
  const PixelRay ray(task, x, y);
  std::vector<RaySegment> segments;
  for (const int* rank = cells.begin; rank < cells.end; ++rank) {
    RaySegment segment;
    if (!task.cells[*rank].pixels.holds(x, y)) continue;
    if (TileCell(task, *rank).meets(ray, task.camera.orthographic, segment)) segments.push_back(segment);
  }
  std::stable_sort(segments.begin(), segments.end(),
                   [](const RaySegment& a, const RaySegment& b) { return a.middle() < b.middle(); });
  for (const RaySegment& segment : segments) {
    if (integral.through() < task.through) return;
    addSegment(segment, ray, integral);
  }
}

void compositeTile(const TileTask& task, const TileCells& cells, Image& image) {
  const PixelBox& tile = cells.pixels;
  std::vector<PixelRay> rays;
  for (int y = tile.first_y; y < tile.end_y; ++y) {
    for (int x = tile.first_x; x < tile.end_x; ++x) rays.emplace_back(task, x, y);
  }
  const RayIntegral empty(task.transfer, task.psi);
  std::vector<RayIntegral> integrals(rays.size(), empty);
  std::vector<double> last(rays.size());  // middle of the last segment
  std::vector<bool> is_wrong(rays.size());
  for (const int* rank = cells.begin; rank < cells.end; ++rank) {
    const TileCell cell(task, *rank);
    const PixelBox box = common(cell.pixels, tile);
    for (int y = box.first_y; y < box.end_y; ++y) {
      for (int x = box.first_x; x < box.end_x; ++x) {
        const std::size_t pixel = tile.index(x, y);
        RaySegment segment;
        RayIntegral& integral = integrals[pixel];
        if (!cell.meets(rays[pixel], task.camera.orthographic, segment)) continue;
        if (segment.middle() < last[pixel]) is_wrong[pixel] = true;
        if (integral.through() < task.through) continue;
        last[pixel] = segment.middle();
        addSegment(segment, rays[pixel], integral);
      }
    }
  }
  for (int y = tile.first_y; y < tile.end_y; ++y) {
    for (int x = tile.first_x; x < tile.end_x; ++x) {
      RayIntegral& integral = integrals[tile.index(x, y)];
      if (cells.sort_rays && is_wrong[tile.index(x, y)]) {
        integral = empty;
        compositeSorted(task, cells, x, y, integral);
      }
      image.at(x, y) = integral.color();
    }
  }
}

}  // namespace emscape::render
