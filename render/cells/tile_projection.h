/// Cell projection by tiles of pixels, on the CPU.
#pragma once

#include <vector>

#include "emscape/render/picture/image.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/integral/lane_transfer.h"
#include "render/cells/tile_cells.h"

namespace emscape::render {

/// Cells prepared for compositing from the front to the back, tile by tile.
class TileProjection {
 public:
  /// @param task   without mesh and cells
  /// @param order      all cells, the farthest first
  /// @param sort_rays  rays that meet cells in the wrong order are composited again, with their segments
  /// sorted: across gaps in the mesh, and in visibility cycles. All cells are then checked, also those behind
  /// opaque ones
  TileProjection(const TileTask& task, const CellMesh& mesh, const std::vector<std::int32_t>& order,
                 bool sort_rays);

  /// Number of cells with a field in the picture.
  long long cells() const;
  /// The picture, without ground. Vectorised if psi has a table.
  Image composite() const;

 private:
  TileGrid grid_;
  TileTask task_;
  bool sort_rays_;
  std::vector<ViewPoint> points_;
  std::vector<PlacedCell> cells_;
  TileLists lists_;
};

/// Ranks of the cells of a tile, and its pixels.
struct TileCells {
  PixelBox pixels;
  const int* begin;
  const int* end;
  bool sort_rays = false;  ///< see TileProjection
};

/// Composites a pixel with its segments sorted. @param integral  receives them
void compositeSorted(const TileTask& task, const TileCells& cells, int x, int y, RayIntegral& integral);
/// Composites one pixel after another.
void compositeTile(const TileTask& task, const TileCells& cells, Image& image);
/// Composites the pixels of a row in vector lanes. Colours differ by less than 1e-6. Without AVX2 it calls
/// compositeTile().
void compositeTileInLanes(const TileTask& task, const LaneTransferView& transfer, const TileCells& cells,
                          Image& image);

}  // namespace emscape::render
