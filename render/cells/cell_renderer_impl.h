/// What the two ways of drawing cells share.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "emscape/render/cell_renderer.h"
#include "render/cells/cell_caster.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/cell_packets.h"
#include "render/cells/cell_rasterizer.h"
#include "render/cells/face_tiles.h"
#include "render/cells/linear_transfer.h"
#include "render/scene.h"

namespace emscape::render {

struct CellRenderer::Impl {
  mutable Scene scene;
  CellMesh cells;
  std::optional<LinearTransfer> transfer;
  std::unique_ptr<CellCaster> caster;              ///< of a GPU; null: the CPU casts
  std::unique_ptr<gl::CellRasterizer> rasterizer;  ///< made when it is first needed

  /// The ground's first points on all rays; empty: there is none.
  std::vector<GroundHit> ground(const RaycastTask& task) const;
  Image castOnDevice(const RaycastTask& task, const FaceTiles& tiles, int start_cell, CellReport& report);
  /// The tile's pixels into the image; `exact` is marched in turn, all else by packets.
  /// @return the rays that met the mesh and the cells that they passed
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
