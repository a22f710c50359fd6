/// Meshes of tetrahedra for tests.
#pragma once

#include <functional>
#include <random>

#include "emscape/volume/mesh/mesh.h"

namespace emscape::test {

/// A lattice of points x * y * z over a box, split into tetrahedra.
/// @param jitter  inner points are moved at random by up to this part of the spacing, 0..0.2
inline volume::TetrahedralMesh boxMesh(const Dims& points, const Vec3d& lower_m, const Vec3d& upper_m,
                                       double jitter = 0) {
  volume::TetrahedralMesh mesh;
  const Vec3d size = upper_m - lower_m;
  const Vec3d spacing{size.x / (points.x - 1), size.y / (points.y - 1), size.z / (points.z - 1)};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-jitter, jitter);
  const auto along = [&](int n, int count, double lower, double upper, double step) {
    const bool is_inner = n > 0 && n + 1 < count;
    return n + 1 == count ? upper : lower + step * (n + (is_inner ? within(random) : 0.0));
  };
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        mesh.points_m.push_back({along(i, points.x, lower_m.x, upper_m.x, spacing.x),
                                 along(j, points.y, lower_m.y, upper_m.y, spacing.y),
                                 along(k, points.z, lower_m.z, upper_m.z, spacing.z)});
      }
    }
  }
  mesh.cells = volume::latticeCells(points);
  return mesh;
}

/// Adds the cells of another mesh; no point is shared.
inline void append(volume::TetrahedralMesh& mesh, const volume::TetrahedralMesh& other) {
  const auto before = static_cast<std::int32_t>(mesh.points_m.size());
  mesh.points_m.insert(mesh.points_m.end(), other.points_m.begin(), other.points_m.end());
  for (auto cell : other.cells) {
    for (auto& vertex : cell) vertex += before;
    mesh.cells.push_back(cell);
  }
}

/// A field on a mesh, given by a function of the position.
inline volume::MeshField fieldOn(volume::TetrahedralMesh mesh,
                                 const std::function<double(const Vec3d&)>& value) {
  volume::MeshField field;
  for (const Vec3d& point : mesh.points_m) field.values.push_back(static_cast<float>(value(point)));
  field.mesh = std::make_shared<volume::TetrahedralMesh>(std::move(mesh));
  field.info.quantity = "density";
  field.info.unit = "kg/m3";
  field.info.floor = -1;
  volume::setRangeFromValues(field);
  return field;
}

}  // namespace emscape::test
