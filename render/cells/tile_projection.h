/// Cell projection by tiles of pixels, on the CPU.
#pragma once

#include <vector>

#include "emscape/render/image.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/lane_transfer.h"
#include "render/cells/tile_cells.h"

namespace emscape::render {

/// Cells ready to be composited from the front to the back, tile by tile.
class TileProjection {
 public:
  /// @param task   its mesh and cells are not set yet
  /// @param order  all cells, the farthest first
  TileProjection(const TileTask& task, const CellMesh& mesh, const std::vector<std::int32_t>& order);

  /// The number of those that hold a field and are in the picture.
  long long cells() const;
  /// The picture, without ground. A psi with a table is composited in lanes.
  Image composite() const;

 private:
  TileGrid grid_;
  TileTask task_;
  std::vector<ViewPoint> points_;
  std::vector<PlacedCell> cells_;
  TileLists lists_;
};

/// The ranks of the cells of a tile, and its pixels.
struct TileCells {
  PixelBox pixels;
  const int* begin;
  const int* end;
};

/// One pixel after another.
void compositeTile(const TileTask& task, const TileCells& cells, Image& image);
/// The pixels of a row in the lanes of vector registers. Colours differ by less than 1e-6. Without AVX2 it is
/// compositeTile().
void compositeTileInLanes(const TileTask& task, const LaneTransferView& transfer, const TileCells& cells,
                          Image& image);

}  // namespace emscape::render
