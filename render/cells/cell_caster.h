/// Rays through cells on a GPU.
#pragma once

#include <memory>
#include <vector>

#include "emscape/render/image.h"
#include "render/cells/cell_walk.h"
#include "render/cells/face_tiles.h"
#include "render/cells/linear_transfer.h"

namespace emscape::render {

/// What is cast for a picture.
struct CellCast {
  CameraView camera;
  int start_cell = -1;  ///< that holds the eye; -1: none does
  double through = 0;   ///< MarchLimits::through
  bool table = true;    ///< Psi from the table, else in closed form
  /// Per pixel the distance at which its ray ends; empty: none ends.
  std::vector<double> end_distance;
};

struct CellCounts {
  unsigned long long rays = 0, cells = 0;
};

/// One thread uses it.
class CellCaster {
 public:
  virtual ~CellCaster() = default;

  /// @param points_too  false: only the values changed
  virtual void setMesh(const CellMesh& mesh, bool points_too) = 0;
  virtual void setTransfer(const LinearTransfer& transfer) = 0;
  /// @throws Error (device)
  virtual CellCounts cast(const CellCast& cast, const FaceTiles& tiles, Image& image) = 0;
};

/// @throws Error (device) in a build without CUDA
std::unique_ptr<CellCaster> makeCudaCellCaster();

}  // namespace emscape::render
