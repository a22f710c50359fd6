/// Order in which projected cells are drawn: the farthest first.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "render/cast/raycast.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/cell_walk.h"

namespace emscape::render {

struct CellOrder {
  std::vector<std::int32_t> cells;  ///< the farthest first
  /// Number of faces across which the order is wrong because of visibility cycles; by centroids 0 (not
  /// counted).
  long long cycles = 0;
};

/// Sort key, increasing with the distance of a cell's centroid. @param depth  DepthAxes::depth
EMSCAPE_HD inline std::uint32_t centroidKey(const CellMeshView& mesh, const CameraView& camera,
                                            const Vec3d& depth, int cell) {
  Vec3d sum{0, 0, 0};
  for (int n = 0; n < 4; ++n) sum = sum + mesh.points[mesh.vertex(cell, n)];
  const Vec3d from_eye = sum - camera.eye * 4.0;
  const auto distance = static_cast<float>(camera.orthographic ? dot(sum, depth) : dot(from_eye, from_eye));
  std::uint32_t bits;  // their order as unsigned numbers is that of the floats
  std::memcpy(&bits, &distance, sizeof bits);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

/// Faces across which a cell hides its neighbour: one bit per face.
EMSCAPE_HD inline std::uint8_t facesBehind(const CellMeshView& mesh, const CameraView& camera, int cell) {
  std::uint8_t behind = 0;
  for (int i = 0; i < 4; ++i) {
    const volume::FaceId here = 4 * cell + i, there = mesh.other_side[here];
    if (there == volume::kNoFace) continue;
    // Both sides of a face use the same numbers.
    const volume::FaceId decides = here < there ? here : there;
    const auto corner = [&](int n) {
      return mesh.points[mesh.vertex(decides / 4, faceVertex(decides % 4, n))];
    };
    const Vec3d a = corner(0), outward = cross(corner(1) - a, corner(2) - a);
    const double away = camera.orthographic ? dot(outward, camera.forward) : dot(outward, a - camera.eye);
    if (here == decides ? away > 0 : away < 0) behind |= static_cast<std::uint8_t>(1 << i);
  }
  return behind;
}

/// Orders by the centroids' distances from the eye (parallel rays: depths). Wrong for some neighbours.
CellOrder centroidOrder(const CellMesh& mesh, const CameraView& camera);

/// Orders every cell after those that it hides across its faces, otherwise by centroids (MPVO: P. Williams,
/// Visibility-ordering meshed polyhedra, 1992). Correct for convex meshes without cycles. In other meshes
/// cells on both sides of a gap are ordered by centroids.
CellOrder visibilityOrder(const CellMesh& mesh, const CameraView& camera);

}  // namespace emscape::render
