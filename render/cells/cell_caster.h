/// Tetrahedral cells on a GPU: ray casting, and projection by tiles of pixels.
#pragma once

#include <memory>
#include <vector>

#include "emscape/render/picture/image.h"
#include "render/cells/cell_walk.h"
#include "render/cells/face_tiles.h"
#include "render/cells/integral/linear_transfer.h"
#include "render/cells/tile_cells.h"

namespace emscape::render {

/// Parameters of ray casting for a picture.
struct CellCast {
  CameraView camera;
  int start_cell = -1;  ///< cell that contains the eye; -1: none
  double through = 0;   ///< MarchLimits::through
  bool table = true;    ///< Psi from the table, else in closed form
  /// Distance at which the ray of each pixel ends; empty: no ray ends.
  std::vector<double> end_distance;
};

struct CellCounts {
  unsigned long long rays = 0, cells = 0;
};

/// Parameters of projection for a picture.
struct TileCast {
  TileTask task;      ///< camera, axes and `through`; the other members are not read
  bool table = true;  ///< Psi from the table, else in closed form
  /// Depth at which the ray of each pixel ends; empty: no ray ends.
  std::vector<double> end_depth;
  CellSorting sorting = CellSorting::visibility;
};

struct TileTimes {
  double order_ms = 0, bin_ms = 0, draw_ms = 0;  ///< by the GPU's clock
  long long cells = 0;                           ///< cells with a field in the picture
  long long cycles = 0;                          ///< CellOrder::cycles
};

/// Not thread-safe.
class CellCaster {
 public:
  virtual ~CellCaster() = default;

  /// @param points_too  false: only the values have changed
  virtual void setMesh(const CellMesh& mesh, bool points_too) = 0;
  virtual void setTransfer(const LinearTransfer& transfer) = 0;
  /// @throws Error (device)
  virtual CellCounts cast(const CellCast& cast, const FaceTiles& tiles, Image& image) = 0;
  /// @throws Error (device)
  virtual TileTimes project(const TileCast& cast, Image& image) = 0;
};

/// @throws Error (device) in a build without CUDA
std::unique_ptr<CellCaster> makeCudaCellCaster();

}  // namespace emscape::render
