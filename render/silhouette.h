/// The pixels of a picture whose rays meet a box.
#pragma once

#include <vector>

#include "render/raycast.h"

namespace emscape::render {

/// Pixels begin <= x < end of a row; none where end <= begin.
struct Span {
  int begin = 0, end = 0;

  EMSCAPE_HD bool contains(int x) const { return x >= begin && x < end; }
};

/// What a box covers of a picture: it is convex, hence one span a row.
struct Silhouette {
  std::vector<Span> rows;  ///< of the picture, from the top

  long long count() const;
};

/// The silhouette of a box in index space, by the same test that a ray is cast by: the first and the last
/// pixel of each span meet the box (see clip()), and no pixel outside of a span does. Rays within the box'
/// own rounding errors of its outline aside, all pixels between meet it.
/// @param silhouette  is written; its memory is used again
void findSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper, Silhouette& silhouette);

/// The same for rays that are cast with other rounding errors: what the box passes by within a 64th of a
/// pixel is in it too, and every pixel of the picture where the eye is in the box or close to it.
void findWideSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper,
                        Silhouette& silhouette);

/// A box in index space.
struct IndexBox {
  Vec3d lower, upper;
};

/// Boxes around all bricks in which some sample has an opacity (SkipView::kNever), one for each row of bricks
/// that has any. A ray that meets none of them shows nothing in DVR, nor in MIDA.
/// @param skip  with levels
std::vector<IndexBox> visibleBoxes(const SkipView& skip, const Dims& voxels);

/// Takes from each span's ends the pixels whose rays meet none of the boxes; rays that pass by closely may
/// stay.
void narrowSilhouette(const CameraView& camera, const std::vector<IndexBox>& boxes, Silhouette& silhouette);

/// Every pixel of a picture.
void wholePicture(ImageSize size, Silhouette& silhouette);

}  // namespace emscape::render
