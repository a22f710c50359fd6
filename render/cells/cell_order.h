/// Order in which projected cells are drawn: the farthest first.
#pragma once

#include <cstdint>
#include <vector>

#include "render/cells/cell_mesh.h"
#include "render/raycast.h"

namespace emscape::render {

struct CellOrder {
  std::vector<std::int32_t> cells;  ///< the farthest first
  /// Number of faces across which the order is wrong because of visibility cycles; by centroids 0 (not
  /// counted).
  long long cycles = 0;
};

/// Sort key, increasing with the distance of a cell's centroid. @param depth  DepthAxes::depth
EMSCAPE_HD inline float centroidDepth(const CellMeshView& mesh, const CameraView& camera, const Vec3d& depth,
                                      int cell) {
  Vec3d sum{0, 0, 0};
  for (int n = 0; n < 4; ++n) sum = sum + mesh.points[mesh.vertex(cell, n)];
  const Vec3d from_eye = sum - camera.eye * 4.0;
  return static_cast<float>(camera.orthographic ? dot(sum, depth) : dot(from_eye, from_eye));
}

/// Orders by the centroids' distances from the eye (parallel rays: depths). Wrong for some neighbours.
CellOrder centroidOrder(const CellMesh& mesh, const CameraView& camera);

/// Orders every cell after those that it hides across its faces, otherwise by centroids (MPVO: P. Williams,
/// Visibility-ordering meshed polyhedra, 1992). Correct for convex meshes without cycles. In other meshes
/// cells on both sides of a gap are ordered by centroids.
CellOrder visibilityOrder(const CellMesh& mesh, const CameraView& camera);

}  // namespace emscape::render
