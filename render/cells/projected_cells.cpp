#include "render/cells/projected_cells.h"

#include <algorithm>

namespace emscape::render {
namespace {

/// As volume::kFaceVertices: counter-clockwise from outside.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

double volume6(const SeenCell& cell) {
  const auto& p = cell.points;
  return dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
}

/// Of the area of a face, outward.
Vec3d outwardOf(const SeenCell& cell, int face) {
  const auto& p = cell.points;
  const int* const v = kFaces[face];
  return cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
}

}  // namespace

bool projectCell(const SeenCell& cell, const Vec3d* along, CellProjection projection, float* vertices,
                 float* numbers) {
  const auto& p = cell.points;
  const double all = volume6(cell);
  // Perspective: lambda_i of the eye, the origin. Parallel rays: its change per depth.
  std::array<double, 4> lambda;
  double ray_value = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3d outward = outwardOf(cell, i);
    lambda[i] = (along != nullptr ? -dot(outward, *along) : dot(outward, p[kFaces[i][0]])) / all;
    ray_value += lambda[i] * cell.values[i];
    vertices[0] = static_cast<float>(p[i].x);
    vertices[1] = static_cast<float>(p[i].y);
    vertices[2] = static_cast<float>(p[i].z);
    vertices[3] = static_cast<float>(cell.values[i]);
    vertices += kFloatsOfVertex;
  }
  const bool is_exact = projection == CellProjection::exact;
  for (int i = 0; i < 4; ++i) {
    double exit = 0, change = 0;
    if (along != nullptr) {  // lambda_i falls from 1 at the vertex to 0 at the face
      if (lambda[i] != 0) exit = -1 / lambda[i];
      change = exit * ray_value;
    } else if (is_exact) {
      if (lambda[i] != 0) exit = 1 / lambda[i];
    } else if (lambda[i] != 1) {
      const double t = 1 / (lambda[i] - 1);
      exit = t * length(p[i]);
      change = t * (cell.values[i] - ray_value);
    }
    numbers[i] = static_cast<float>(exit);
    if (!is_exact) numbers[4 + i] = static_cast<float>(change);
  }
  if (is_exact) numbers[4] = static_cast<float>(ray_value);
  return along != nullptr || *std::min_element(lambda.begin(), lambda.end()) <= 0;
}

}  // namespace emscape::render
