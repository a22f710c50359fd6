/// The pixels of a picture whose rays meet a box.
#pragma once

#include <vector>

#include "render/cast/raycast.h"

namespace emscape::render {

/// Pixels begin <= x < end of a row; none if end <= begin.
struct Span {
  int begin = 0, end = 0;

  EMSCAPE_HD bool contains(int x) const { return x >= begin && x < end; }
};

/// The pixels covered by a box: it is convex, so each row has one span.
struct Silhouette {
  std::vector<Span> rows;  ///< of the picture, from the top

  long long count() const;
};

/// The silhouette of a box in index space, by the test that is used in casting a ray: the first and the last
/// pixel of each span meet the box (see clip()), and no pixel outside of a span does. Except for rays within
/// rounding errors of the outline, all pixels between meet the box.
/// @param silhouette  overwritten; its memory is reused
void findSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper, Silhouette& silhouette);

/// The same for rays that are cast with other rounding errors: pixels within 1/64 pixel of the box are
/// included, and every pixel of the picture if the eye is in the box or close to it.
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

/// Removes pixels at the ends of each span whose rays meet none of the boxes; rays that pass closely may
/// remain.
void narrowSilhouette(const CameraView& camera, const std::vector<IndexBox>& boxes, Silhouette& silhouette);

/// Every pixel of a picture.
void wholePicture(ImageSize size, Silhouette& silhouette);

}  // namespace emscape::render
