/// The boundary faces of a mesh by the tiles of a picture: which rays enter the mesh where.
#pragma once

#include <cstddef>
#include <vector>

#include "emscape/render/camera.h"
#include "render/cells/cell_march.h"

namespace emscape::render {

/// Pixels first_x..end_x - 1, first_y..end_y - 1.
struct PixelBox {
  int first_x = 0, first_y = 0, end_x = 0, end_y = 0;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_y) * (end_x - first_x) + (x - first_x);
  }
};

class FaceTiles {
 public:
  static constexpr int kTile = 16;  ///< pixels along a side

  FaceTiles(const CellMesh& mesh, const SceneBox& box, const Camera& camera, ImageSize size);

  /// The faces of each tile, one tile after another.
  struct Lists {
    std::vector<volume::FaceId> faces;
    std::vector<int> first;  ///< of each tile in it; one more at the end
  };
  Lists lists() const;

  int count() const { return columns_ * rows_; }
  PixelBox pixelsOf(int tile) const;
  /// The entries of each pixel's ray, in the order of PixelBox::index(). In perspective those behind the eye
  /// are left out.
  std::vector<std::vector<EntryHit>> entriesOf(int tile, const CellMesh& mesh,
                                               const CameraView& camera) const;

 private:
  /// A face and the pixels that it may cover.
  struct Covered {
    volume::FaceId face;
    PixelBox pixels;
  };

  ImageSize size_;
  int columns_, rows_;
  std::vector<Covered> faces_;
  std::vector<std::size_t> first_;  ///< of each tile in members_; one more at the end
  std::vector<int> members_;        ///< indices of faces_, ascending in each tile
};

}  // namespace emscape::render
