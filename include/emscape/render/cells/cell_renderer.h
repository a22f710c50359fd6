/// Renderer of fields on tetrahedral meshes.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "emscape/base/backend.h"
#include "emscape/base/enum_names.h"
#include "emscape/base/progress.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/mesh/mesh.h"

namespace emscape::render {

using emscape::toString;

/// Number of reference steps across a mesh's bounding box along each axis.
constexpr int kReferenceSteps = 100;

/// Grid whose voxels are the reference steps of a mesh. The opacity of a transfer function refers to one
/// hundredth of the points' bounding box along each axis. A ray through n steps of opacity a has the
/// transmittance (1 - a)^n, however fine the mesh is.
volume::Grid referenceGridOf(const volume::TetrahedralMesh& mesh);

/// Default for the values at the points, as for a volume; NaN is ignored.
TransferFunction defaultTransferFunction(const volume::MeshField& field, const ColorRange& range = {});

/// Cost of a picture.
struct CellReport {
  long long rays = 0;   ///< rays that met the mesh
  long long cells = 0;  ///< cells crossed by all rays
  double cast_ms = 0;
  bool complete = true;  ///< false: rendering was stopped
};

/// Computation of a ray's exit from a cell in perspective; with parallel rays both forms are equal.
enum class CellProjection {
  published,  ///< from interpolated distances (Moreland 2004): sometimes a wrong face near the eye
  exact
};
constexpr auto namesOf(CellProjection) {
  return std::array{"published", "exact"};
}
/// Order in which cells are projected, the farthest first.
enum class CellSorting {
  centroids,  ///< by the distances of centroids: wrong for some neighbours
  /// Every cell after those that it hides across its faces: correct for convex meshes without cycles; by
  /// centroids across gaps of non-convex meshes
  visibility
};
constexpr auto namesOf(CellSorting) {
  return std::array{"centroids", "visibility"};
}
/// Rasteriser of projected cells.
enum class Rasterizer {
  automatic,  ///< tiles with CUDA or if OpenGL has no GPU, else opengl; the published form in perspective
              ///< always by opengl
  opengl,     ///< without a window
  tiles       ///< tiles of pixels, computed by the renderer's backend; in perspective only the exact form
};
constexpr auto namesOf(Rasterizer) {
  return std::array{"auto", "opengl", "tiles"};
}
/// "published" or "exact". @throws Error (usage)
CellProjection parseCellProjection(const std::string& name);
/// "centroids" or "visibility". @throws Error (usage)
CellSorting parseCellSorting(const std::string& name);
/// "auto", "opengl" or "tiles". @throws Error (usage)
Rasterizer parseRasterizer(const std::string& name);

/// @throws Error (usage) for settings not supported on tetrahedra: a mode other than dvr, shading, planes
void checkCellSettings(const RenderSettings& settings);

struct ProjectionOptions {
  CellProjection projection = CellProjection::exact;
  CellSorting sorting = CellSorting::visibility;
  Rasterizer rasterizer = Rasterizer::automatic;
};

/// Cost of a picture by projection.
struct ProjectionReport {
  Rasterizer rasterizer = Rasterizer::automatic;  ///< the one used
  std::string device;                             ///< OpenGL's name of it; tiles: "cpu" or "cuda"
  long long cells = 0;                            ///< cells drawn; tiles: cells that may cover a pixel
  long long cycles = 0;  ///< faces across which the order is wrong; not counted for centroids
  std::size_t sent_bytes = 0;
  double order_ms = 0, draw_ms = 0;
  double bin_ms = 0;     ///< part of draw_ms: listing the cells of each tile; 0 with OpenGL
  double device_ms = 0;  ///< part of draw_ms: time on the GPU, by its clock; 0 without a GPU
};

/// Draws fields on tetrahedra by emission and absorption (dvr). The field is linear in each cell and is
/// integrated in closed form, without a sampling distance. The ground is opaque. Not thread-safe; rendering
/// uses all threads that base/parallel.h allows.
class CellRenderer {
 public:
  /// @param backend  backend that casts the rays; automatic: a GPU if there is one
  /// @throws Error (device) if cuda is requested and not available
  explicit CellRenderer(Backend backend = Backend::cpu);
  ~CellRenderer();

  /// cpu or cuda.
  Backend backend() const;

  /// @param faces  of the field's mesh; setting another field on the same mesh is cheap
  /// @throws Error (bad_input) for categorical values, which are not linear in a cell, and malformed fields
  void setField(const volume::MeshField& field, std::shared_ptr<const volume::MeshFaces> faces);
  /// Null: no ground is drawn. @throws Error (bad_input) for an invalid field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  /// @param function  not categorical
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// Only `exact` (no early termination, Psi in closed form) and the vertical exaggeration have an effect.
  /// @throws Error (usage) as checkCellSettings(); (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const TransferFunction& transferFunction() const;
  const Camera& camera() const;
  /// Bounding box of the mesh in scene coordinates. A field must be set.
  SceneBox sceneBox() const;
  /// Whether the ground hides a position (frame metres) from the camera. A field must be set.
  bool isHidden(const Vec3d& frame_m) const;

  /// Ray casting: every ray is followed from cell to cell. Returns premultiplied colours without background.
  /// The picture does not depend on the number of threads; those of a GPU and of other instruction sets
  /// differ by rounding (1e-5).
  /// @param stop  set by another thread: returns soon, incomplete; no effect on a GPU. May be null
  Image render(ImageSize size, const StopFlag* stop = nullptr, CellReport* report = nullptr);
  /// True if OpenGL is software on the CPU, such as Mesa's llvmpipe; render() is then faster.
  /// @throws Error (device) without OpenGL 3.3, or in a build without libepoxy
  bool projectsOnCpu();
  /// The same picture by projection of the cells.
  /// @accuracy exact, visibility: tiles within 1e-5 of render() where the order is correct; OpenGL within
  /// 1e-5 in 98 % of the pixels, mean 2e-6, max 2e-4 where no edge of a cell is within 1/32 pixel, else max
  /// 2e-2: rasterisers round to 1/256 pixel
  /// @throws Error (usage) for the published form by tiles in perspective; (device) for opengl as
  /// projectsOnCpu()
  Image project(ImageSize size, const ProjectionOptions& options = {}, ProjectionReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
