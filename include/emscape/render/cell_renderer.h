/// Fields on tetrahedra -> picture.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/render/camera.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/render/render_settings.h"
#include "emscape/render/transfer_function.h"
#include "emscape/volume/mesh.h"

namespace emscape::render {

/// Reference steps across the box of a mesh along each axis.
constexpr int kReferenceSteps = 100;

/// The grid whose voxels are the reference steps of a mesh: the opacity of a transfer function is that of one
/// hundredth of the box of the points along each axis. A ray that crosses n of these of opacity a lets
/// (1 - a)^n through, however fine the mesh is.
volume::Grid referenceGridOf(const volume::TetrahedralMesh& mesh);

/// As for a volume, by the values at the points; see there. NaN is left out.
TransferFunction defaultTransferFunction(const volume::MeshField& field);

/// What a picture took.
struct CellReport {
  long long rays = 0;   ///< that met the mesh
  long long cells = 0;  ///< passed by all of them
  double cast_ms = 0;
  bool complete = true;  ///< false: it was stopped
};

/// How projection finds where a ray leaves a cell in perspective; with parallel rays both are the same.
enum class CellProjection {
  published,  ///< from interpolated distances, as Moreland 2004: at times a wrong face, near the eye
  exact
};
/// The order in which cells are projected, the farthest first.
enum class CellSorting {
  centroids,  ///< by the distances of centroids: wrong for some neighbours
  /// Every cell after those that it hides across its faces: right for convex meshes without cycles; across
  /// the gaps of others by centroids
  visibility
};
/// What finds the pixels that a projected cell covers.
enum class Rasterizer {
  automatic,  ///< tiles with CUDA and where OpenGL has no GPU, else opengl; the published form by opengl
              ///< alone
  opengl,     ///< without a window
  tiles       ///< tiles of pixels, computed by the renderer's backend; in perspective the exact form alone
};
const char* toString(CellProjection projection);
const char* toString(CellSorting sorting);
const char* toString(Rasterizer rasterizer);
/// "published" or "exact". @throws Error (usage)
CellProjection parseCellProjection(const std::string& name);
/// "centroids" or "visibility". @throws Error (usage)
CellSorting parseCellSorting(const std::string& name);
/// "auto", "opengl" or "tiles". @throws Error (usage)
Rasterizer parseRasterizer(const std::string& name);

/// @throws Error (usage) for settings without a meaning on tetrahedra: another mode than dvr, shading, planes
void checkCellSettings(const RenderSettings& settings);

struct ProjectionOptions {
  CellProjection projection = CellProjection::exact;
  CellSorting sorting = CellSorting::visibility;
  Rasterizer rasterizer = Rasterizer::automatic;
};

/// What a picture by projection took.
struct ProjectionReport {
  Rasterizer rasterizer = Rasterizer::automatic;  ///< that drew it
  std::string device;                             ///< as OpenGL names it; of tiles "cpu" or "cuda"
  long long cells = 0;                            ///< drawn; by tiles those that may cover a pixel
  long long cycles = 0;  ///< faces across which the order is wrong; not counted by centroids
  std::size_t sent_bytes = 0;
  double order_ms = 0, draw_ms = 0;
  double bin_ms = 0;     ///< of draw_ms: until all tiles know their cells; 0 by OpenGL
  double device_ms = 0;  ///< of draw_ms: what the GPU spent, by its own clock; 0 where there is none
};

/// Draws fields on tetrahedra by emission and absorption (dvr). The field, linear in each cell, is integrated
/// in closed form: there is no sampling distance. The ground hides what is behind it. One thread uses it; a
/// picture uses all threads that base/parallel.h allows.
class CellRenderer {
 public:
  /// @param backend  where rays are cast; automatic: on a GPU if there is one
  /// @throws Error (device) if cuda is requested and there is none
  explicit CellRenderer(Backend backend = Backend::cpu);
  ~CellRenderer();

  /// cpu or cuda.
  Backend backend() const;

  /// @param faces  of the field's mesh. A field on the same mesh as before is cheap to set
  /// @throws Error (bad_input) for categorical values, which are not linear in a cell, and malformed fields
  void setField(const volume::MeshField& field, std::shared_ptr<const volume::MeshFaces> faces);
  /// Null: no ground is drawn. @throws Error (bad_input) for an impossible field
  void setHeightField(std::shared_ptr<const HeightField> height_field);
  /// @param function  not categorical
  void setTransferFunction(const TransferFunction& function);
  void setCamera(const Camera& camera);
  /// Of the settings count `exact` (no early termination, and Psi in closed form) and the exaggeration.
  /// @throws Error (usage) as checkCellSettings(); (bad_input) for a value out of its range
  void setSettings(const RenderSettings& settings);

  const TransferFunction& transferFunction() const;
  const Camera& camera() const;
  /// The box of the mesh as it is drawn. A field must be set.
  SceneBox sceneBox() const;
  /// Whether the ground hides a position (frame metres) from the camera. A field must be set.
  bool isHidden(const Vec3d& frame_m) const;

  /// The picture, premultiplied, without background: every ray is followed from cell to cell. It does not
  /// depend on the number of threads; pictures of a GPU and of other instruction sets differ by rounding
  /// (1e-5).
  /// @param stop  set from elsewhere: returns soon, incomplete; without effect on a GPU. May be null
  Image render(ImageSize size, const StopFlag* stop = nullptr, CellReport* report = nullptr);
  /// True if OpenGL is a program on the CPU, such as Mesa's llvmpipe: there render() is faster.
  /// @throws Error (device) without OpenGL 3.3, or in a build without libepoxy
  bool projectsOnCpu();
  /// The same by projection of the cells.
  /// @accuracy exact, visibility: by tiles within 1e-5 of render(), where the order is right; by OpenGL in 98
  /// % of the pixels, 2e-6 in the mean; 2e-4 at most where no edge of a cell is within 1/32 pixel, else 2e-2:
  /// rasterisers round to 1/256 pixel
  /// @throws Error (usage) for the published form by tiles in perspective; (device) for opengl as
  /// projectsOnCpu()
  Image project(ImageSize size, const ProjectionOptions& options = {}, ProjectionReport* report = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
