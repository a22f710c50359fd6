/// Parts of a mesh as text, for messages. Internal to the module.
#pragma once

#include <string>

#include "emscape/volume/mesh/mesh.h"

namespace emscape::volume {

/// "cell 3 (points 0, 4, 2, 7)".
inline std::string cellText(const TetrahedralMesh& mesh, long long cell) {
  const auto& v = mesh.cells[static_cast<std::size_t>(cell)];
  return "cell " + std::to_string(cell) + " (points " + std::to_string(v[0]) + ", " + std::to_string(v[1]) +
         ", " + std::to_string(v[2]) + ", " + std::to_string(v[3]) + ")";
}

}  // namespace emscape::volume
