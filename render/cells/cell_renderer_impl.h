/// State shared by ray casting and projection of cells.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "emscape/render/cells/cell_renderer.h"
#include "render/cells/cell_caster.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/cell_packets.h"
#include "render/cells/cell_rasterizer.h"
#include "render/cells/face_tiles.h"
#include "render/cells/integral/linear_transfer.h"
#include "render/scene/scene.h"

namespace emscape::render {

struct CellRenderer::Impl {
  mutable Scene scene;
  CellMesh cells;
  std::optional<LinearTransfer> transfer;
  std::unique_ptr<CellCaster> caster;              ///< GPU; null: rays are cast on the CPU
  std::unique_ptr<gl::CellRasterizer> rasterizer;  ///< created at the first use

  /// First intersections of all rays with the ground; empty: no ground.
  std::vector<GroundHit> ground(const RaycastTask& task) const;
  Image castOnDevice(const RaycastTask& task, const FaceTiles& tiles, int start_cell, CellReport& report);
  /// Draws a tile's pixels; `exact` marches one ray after another, otherwise packets are used.
  /// @return the number of rays that met the mesh and of cells crossed
  CellReport castTile(const RaycastTask& task, const FaceTiles& tiles, int tile, int start_cell,
                      const CellPackets& packets, Image& image) const;

  /// Not automatic. @throws Error (usage) as project()
  Rasterizer rasterizerFor(const ProjectionOptions& options, CellRenderer& renderer) const;
  /// @param hits  as ground()
  Image projectByOpenGl(const RaycastTask& task, const ProjectionOptions& options,
                        const std::vector<GroundHit>& hits, ProjectionReport& report);
  Image projectByTiles(const RaycastTask& task, const ProjectionOptions& options,
                       const std::vector<GroundHit>& hits, ProjectionReport& report);
};

}  // namespace emscape::render
