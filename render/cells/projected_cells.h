/// Vertex stage of cell projection, on the CPU: the numbers at the vertices of tetrahedra that the rasteriser
/// interpolates over their entry faces.
///
/// Balanced projection (Moreland 2004): the length of a ray in a cell and the value at its exit follow from
/// numbers at the four vertices, shared by the cell's faces. With lambda_i(eye) the barycentric coordinates
/// of the eye in the cell, the ray through vertex i crosses the plane of the opposite face at
///     t_i = 1 / (lambda_i(eye) - 1)
/// beyond the vertex, in units of the vertex's distance from the eye. u_i = t_i / (1 + t_i) = 1 /
/// lambda_i(eye) is exactly linear over a face; t_i is linear only for parallel rays.
#pragma once

#include <array>

#include "emscape/base/vec.h"
#include "emscape/render/cells/cell_renderer.h"
#include "render/cast/raycast.h"

namespace emscape::render {

/// Numbers sent. Vertex: position relative to the eye (index space) and value. Cell: one for each vertex i,
/// positive where rays leave through the opposite face:
///   exact      u_i; then one more: the value extrapolated to the eye
///   published  the distance from vertex i to the face's plane, all four; then the change of the value
///              from the vertex to there, all four
/// With parallel rays lengths are depths, and the additional number is the change of the value per depth.
constexpr int kFloatsOfVertex = 4;
constexpr int cellNumbers(CellProjection projection) {
  return projection == CellProjection::published ? 8 : 5;
}
constexpr int floatsOfCell(CellProjection projection) {
  return 4 * kFloatsOfVertex + cellNumbers(projection);
}

/// Axes of a camera in index space: their dot products with a position relative to the eye are its
/// coordinates across the view and its depth.
struct DepthAxes {
  Vec3d right, up, depth;

  explicit DepthAxes(const CameraView& camera)
      : right(cross(camera.up, camera.forward)),
        up(cross(camera.forward, camera.right)),
        depth(cross(camera.right, camera.up)) {
    const double volume = dot(camera.right, right);
    right = right / volume;
    up = up / volume;
    depth = depth / volume;
  }
};

/// A cell relative to the eye, in index space, its vertices ordered as TetrahedralMesh states.
struct SeenCell {
  std::array<Vec3d, 4> points;
  std::array<double, 4> values;
};

/// @param along     step of parallel rays for a depth of one; null: perspective
/// @param vertices  receives 4 x kFloatsOfVertex
/// @param numbers   receives cellNumbers()
/// @return false if the cell contains the eye: it has no entry face
bool projectCell(const SeenCell& cell, const Vec3d* along, CellProjection projection, float* vertices,
                 float* numbers);

}  // namespace emscape::render
