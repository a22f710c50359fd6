/// Boundary faces of a mesh by the picture's tiles: the entries of rays into the mesh.
#pragma once

#include <vector>

#include "emscape/render/scene/camera.h"
#include "render/cells/cell_march.h"
#include "render/cells/pixel_tiles.h"

namespace emscape::render {

class FaceTiles {
 public:
  static constexpr int kTile = TileGrid::kTile;

  FaceTiles(const CellMesh& mesh, const SceneBox& box, const Camera& camera, ImageSize size);

  /// Faces of all tiles, one tile after another.
  struct Lists {
    std::vector<volume::FaceId> faces;
    std::vector<int> first;  ///< first face of each tile; one more at the end
  };
  Lists lists() const;

  int count() const { return grid_.count(); }
  PixelBox pixelsOf(int tile) const { return grid_.pixelsOf(tile); }
  /// Entries of each pixel's ray, in the order of PixelBox::index(); in perspective without those behind the
  /// eye.
  std::vector<std::vector<EntryHit>> entriesOf(int tile, const CellMesh& mesh,
                                               const CameraView& camera) const;

 private:
  TileGrid grid_;
  std::vector<volume::FaceId> faces_;
  std::vector<PixelBox> boxes_;  ///< pixels that each face may cover
  TileLists lists_;
};

}  // namespace emscape::render
