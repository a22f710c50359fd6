/// Tetrahedral mesh in the index space of its reference grid, in which rays are cast.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/volume/mesh/mesh.h"

namespace emscape::render {

/// Mesh for ray casting, as plain data. Lengths along rays are in reference steps (referenceGridOf()).
struct CellMeshView {
  const Vec3d* points = nullptr;           ///< index space
  const std::int32_t* vertices = nullptr;  ///< four per cell
  const volume::FaceId* other_side = nullptr;
  const float* values = nullptr;  ///< one per point; NaN: no field

  EMSCAPE_HD std::int32_t vertex(int cell, int n) const { return vertices[4 * cell + n]; }
};

/// Owner of a CellMeshView's memory.
struct CellMesh {
  std::vector<Vec3d> points;
  std::shared_ptr<const volume::TetrahedralMesh> mesh;
  std::shared_ptr<const volume::MeshFaces> faces;
  std::vector<float> values;

  const std::array<std::int32_t, 4>& cell(int n) const { return mesh->cells[static_cast<std::size_t>(n)]; }
  const Vec3d& point(std::int32_t n) const { return points[static_cast<std::size_t>(n)]; }
  CellMeshView view() const {
    return {points.data(), mesh->cells.data()->data(), faces->other_side.data(), values.data()};
  }
};

}  // namespace emscape::render
