#include "emscape/render/cells/cell_renderer.h"

#include <algorithm>
#include <atomic>

#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "render/cells/cell_march.h"
#include "render/cells/cell_packets.h"
#include "render/cells/cell_renderer_impl.h"
#include "render/cells/face_tiles.h"

namespace emscape::render {

void checkCellSettings(const RenderSettings& settings) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::usage, what + ": a field on tetrahedra is drawn without it");
  };
  if (settings.mode != CompositingMode::dvr) {
    throw Error(ErrorCode::usage, std::string("mode ") + toString(settings.mode) +
                                      ": fields on tetrahedra support only mode dvr");
  }
  if (settings.shading) refuse("shading");
  if (settings.map_height_agl_m) refuse("map_layer");
  if (std::any_of(settings.planes.begin(), settings.planes.end(), [](const CutPlane& p) { return p.on; }))
    refuse("plane");
}

volume::Grid referenceGridOf(const volume::TetrahedralMesh& mesh) {
  const volume::MeshBounds bounds = volume::boundsOf(mesh);
  volume::Grid grid;
  grid.dims = {kReferenceSteps, kReferenceSteps, kReferenceSteps};
  grid.spacing_m = (bounds.upper_m - bounds.lower_m) / kReferenceSteps;
  grid.first_center_m = bounds.lower_m + grid.spacing_m * 0.5;
  grid.frame = mesh.frame;
  grid.georeferenced = mesh.georeferenced;
  return grid;
}

TransferFunction defaultTransferFunction(const volume::MeshField& field, const ColorRange& range) {
  const volume::DenseVolume values = volume::valuesOf(field);
  return values.values.empty() ? defaultTransferFunction(field.info, range)
                               : defaultTransferFunction(values, range);
}

CellRenderer::CellRenderer(Backend backend) : impl_(std::make_unique<Impl>()) {
  if (resolveBackend(backend).backend == Backend::cuda) impl_->caster = makeCudaCellCaster();
}
CellRenderer::~CellRenderer() = default;

Backend CellRenderer::backend() const {
  return impl_->caster ? Backend::cuda : Backend::cpu;
}

void CellRenderer::setField(const volume::MeshField& field, std::shared_ptr<const volume::MeshFaces> faces) {
  if (field.info.categorical) {
    throw Error(ErrorCode::bad_input,
                field.info.quantity +
                    " holds indices: these are not drawn on tetrahedra, as a value between "
                    "two of them means nothing");
  }
  volume::checkMeshField(field, {});
  CellMesh& cells = impl_->cells;
  cells.values = field.values;
  const volume::Grid grid = referenceGridOf(*field.mesh);
  const bool is_new_mesh = cells.mesh != field.mesh;
  if (is_new_mesh) {
    cells.mesh = field.mesh;
    cells.points.resize(field.mesh->points_m.size());
    for (std::size_t n = 0; n < cells.points.size(); ++n) {
      const Vec3d offset = field.mesh->points_m[n] - grid.first_center_m;
      cells.points[n] = {offset.x / grid.spacing_m.x, offset.y / grid.spacing_m.y,
                         offset.z / grid.spacing_m.z};
    }
  }
  cells.faces = std::move(faces);
  if (impl_->caster) impl_->caster->setMesh(cells, is_new_mesh);
  volume::VolumeInfo info = field.info;
  info.categorical = false;
  impl_->scene.setVolume(grid, info);
}

void CellRenderer::setHeightField(std::shared_ptr<const HeightField> height_field) {
  impl_->scene.setHeightField(std::move(height_field));
}
void CellRenderer::setTransferFunction(const TransferFunction& function) {
  impl_->transfer.emplace(function);
  if (impl_->caster) impl_->caster->setTransfer(*impl_->transfer);
  impl_->scene.setTransferFunction(function);
}
void CellRenderer::setCamera(const Camera& camera) {
  impl_->scene.setCamera(camera);
}
void CellRenderer::setSettings(const RenderSettings& settings) {
  checkCellSettings(settings);
  impl_->scene.setSettings(settings);
}
const TransferFunction& CellRenderer::transferFunction() const {
  return impl_->scene.transferFunction();
}
const Camera& CellRenderer::camera() const {
  return impl_->scene.camera();
}
SceneBox CellRenderer::sceneBox() const {
  return impl_->scene.box();
}
bool CellRenderer::isHidden(const Vec3d& frame_m) const {
  return impl_->scene.isHidden(frame_m);
}

CellReport CellRenderer::Impl::castTile(const RaycastTask& task, const FaceTiles& tiles, int tile,
                                        int start_cell, const CellPackets& packets, Image& image) const {
  const PixelBox box = tiles.pixelsOf(tile);
  std::vector<std::vector<EntryHit>> entries = tiles.entriesOf(tile, cells, task.camera);
  const CellMeshView view = cells.view();
  const bool exact = scene.settings().exact;
  CellReport report;
  std::vector<GroundHit> ground;
  std::vector<MarchTask> rays;
  for (int y = box.first_y; y < box.end_y; ++y) {
    for (int x = box.first_x; x < box.end_x; ++x) {
      std::vector<EntryHit>& hits = entries[box.index(x, y)];
      ground.push_back(task.groundAt(x, y));
      const RayFrame frame(task.camera.ray(x, y));
      if (start_cell >= 0) {
        // The eye is in the mesh: the line enters this cell behind it.
        EntryHit start{0, entryFaceOf(view, frame, start_cell)};
        entersThrough(view, frame, start.face, start);
        start.distance = std::min(start.distance, 0.0);
        hits.push_back(start);
      }
      if (!hits.empty()) ++report.rays;
      std::sort(hits.begin(), hits.end());
      const double end =
          ground.back().found ? ground.back().distance : std::numeric_limits<double>::infinity();
      rays.push_back({frame, {end, exact ? 0 : 1 - static_cast<double>(kOpaqueEnough)}, std::move(hits), {}});
    }
  }
  const int count = static_cast<int>(rays.size());
  report.cells =
      exact ? marchInTurn(view, transfer->view(), {}, rays.data(), count) : packets.march(rays.data(), count);
  for (int y = box.first_y; y < box.end_y; ++y) {
    for (int x = box.first_x; x < box.end_x; ++x) {
      const GroundHit& behind = ground[box.index(x, y)];
      const Rgba color = rays[box.index(x, y)].color;
      image.at(x, y) = behind.found ? over(color, behind.color) : color;
    }
  }
  return report;
}

std::vector<GroundHit> CellRenderer::Impl::ground(const RaycastTask& task) const {
  std::vector<GroundHit> hits;
  if (!scene.ground()) return hits;
  const ImageSize size = task.camera.size;
  hits.resize(static_cast<std::size_t>(size.count()));
  parallelFor(size.height, 4, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < size.width; ++x) {
        hits[static_cast<std::size_t>(y) * size.width + x] = task.groundAt(x, y);
      }
    }
  });
  return hits;
}

Image CellRenderer::Impl::castOnDevice(const RaycastTask& task, const FaceTiles& tiles, int start_cell,
                                       CellReport& report) {
  const bool exact = scene.settings().exact;
  CellCast cast{task.camera, start_cell, exact ? 0 : 1 - static_cast<double>(kOpaqueEnough), !exact, {}};
  const std::vector<GroundHit> hits = ground(task);
  cast.end_distance.resize(hits.size());
  std::transform(hits.begin(), hits.end(), cast.end_distance.begin(), [](const GroundHit& hit) {
    return hit.found ? hit.distance : std::numeric_limits<double>::infinity();
  });
  Image image;
  const CellCounts counts = caster->cast(cast, tiles, image);
  for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
    if (hits[pixel].found) image.pixels[pixel] = over(image.pixels[pixel], hits[pixel].color);
  }
  report.rays = static_cast<long long>(counts.rays);
  report.cells = static_cast<long long>(counts.cells);
  return image;
}

Image CellRenderer::render(ImageSize size, const StopFlag* stop, CellReport* report) {
  Stopwatch watch;
  Impl& impl = *impl_;
  impl.scene.prepare();
  const RaycastTask task = impl.scene.task(size);
  const FaceTiles tiles(impl.cells, impl.scene.box(), impl.scene.camera(), size);
  const int start_cell = task.camera.orthographic ? -1 : cellAt(impl.cells, task.camera.eye);
  if (impl.caster) {
    CellReport done;
    Image image = impl.castOnDevice(task, tiles, start_cell, done);
    done.cast_ms = watch.lap_ms();
    if (report != nullptr) *report = done;
    return image;
  }
  Image image(size);
  std::atomic<long long> rays{0}, passed{0};
  const CellPackets packets(impl.cells.view(), impl.transfer->view(), PsiTable::shared().lookup());
  const auto isStopped = [stop] { return stop != nullptr && stop->load(std::memory_order_relaxed); };
  parallelFor(tiles.count(), 1, [&](int begin, int end) {
    for (int tile = begin; tile < end && !isStopped(); ++tile) {
      const CellReport of_tile = impl.castTile(task, tiles, tile, start_cell, packets, image);
      rays += of_tile.rays;
      passed += of_tile.cells;
    }
  });
  if (report != nullptr) *report = {rays, passed, watch.lap_ms(), !isStopped()};
  return image;
}

}  // namespace emscape::render
