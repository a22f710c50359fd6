/// A mesh of tetrahedra that follows the ground, with layers that become thicker with height.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/emfield/columns/surface.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/mesh/mesh.h"

namespace emscape::emfield {

/// Layers of cells above each column of a region. The thickness of each is `ratio` times that of the one
/// below it.
struct TerrainMeshSpec {
  int layers = 0;                 ///< 1..4096
  std::optional<double> first_m;  ///< thickness of the lowest, 0.01..10000; none: 5, or less if the layers
                                  ///< would not fit
  /// 1..3; none: the layers end at the top of the region above its lowest ground.
  std::optional<double> ratio;
};

/// Parses `terrain:LAYERS[,FIRST_M[,RATIO]]`. @throws Error (usage) that names the value and its range
TerrainMeshSpec parseTerrainMesh(const std::string& text);

/// Heights of the points above ground (m): layers + 1, from 0.
/// @param height_m  of the region's top above its lowest ground, > 0
/// @throws Error (usage) if layers of this first thickness do not fit in it, and if layers with a ratio reach
/// above 100 km and above height_m
std::vector<double> layerHeights_m(const TerrainMeshSpec& spec, double height_m);

/// The points are above the centres of the region's columns, at layerHeights_m() above ground (above mean sea
/// level without terrain). Hexahedra of eight points are split into six tetrahedra each
/// (volume::latticeCells()). Columns over holes of the terrain are left out. Immutable; threads may share it.
class TerrainMesh {
 public:
  /// @param terrain  of the scenario; null: none
  /// @throws Error (usage) as layerHeights_m(); (bad_input) if the region has fewer than 2 columns along an
  /// axis, if there is terrain in no column, and for more cells than volume::kMaxMeshCells
  TerrainMesh(const scenario::Scenario& scenario, const scenario::Terrain* terrain,
              const TerrainMeshSpec& spec);

  /// For FieldOptions::surface. field() converts the volumes of such a solver.
  const std::shared_ptr<const Surface>& surface() const { return surface_; }
  const std::shared_ptr<const volume::TetrahedralMesh>& mesh() const { return mesh_; }
  /// Converts a volume over surface() to values at the mesh's points; NaN where it is masked.
  volume::MeshField field(const volume::DenseVolume& volume) const;

 private:
  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const volume::TetrahedralMesh> mesh_;
  std::vector<std::size_t> lattice_;  ///< of each point: its index among places x heights
};

}  // namespace emscape::emfield
