/// The boundary faces of a mesh by the tiles of a picture: which rays enter the mesh where.
#pragma once

#include <cstddef>
#include <vector>

#include "emscape/render/camera.h"
#include "render/cells/cell_march.h"
#include "render/cells/pixel_tiles.h"

namespace emscape::render {

class FaceTiles {
 public:
  static constexpr int kTile = TileGrid::kTile;

  FaceTiles(const CellMesh& mesh, const SceneBox& box, const Camera& camera, ImageSize size);

  /// The faces of each tile, one tile after another.
  struct Lists {
    std::vector<volume::FaceId> faces;
    std::vector<int> first;  ///< of each tile in it; one more at the end
  };
  Lists lists() const;

  int count() const { return grid_.count(); }
  PixelBox pixelsOf(int tile) const { return grid_.pixelsOf(tile); }
  /// The entries of each pixel's ray, in the order of PixelBox::index(). In perspective those behind the eye
  /// are left out.
  std::vector<std::vector<EntryHit>> entriesOf(int tile, const CellMesh& mesh,
                                               const CameraView& camera) const;

 private:
  TileGrid grid_;
  std::vector<volume::FaceId> faces_;
  std::vector<PixelBox> boxes_;  ///< the pixels that each may cover
  TileLists lists_;
};

}  // namespace emscape::render
