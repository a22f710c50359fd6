
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "render/cells/cell_order.h"
#include "render/cells/cell_renderer_impl.h"
#include "render/cells/projected_cells.h"
#include "render/cells/tile_projection.h"

namespace emscape::render {
namespace {

CellOrder orderOf(const CellMesh& mesh, const CameraView& camera, CellSorting sorting) {
  return sorting == CellSorting::visibility ? visibilityOrder(mesh, camera) : centroidOrder(mesh, camera);
}

/// False if the cell has no field.
bool seenFrom(const Vec3d& eye, const CellMesh& mesh, std::int32_t cell, SeenCell& seen) {
  const auto& vertices = mesh.cell(cell);
  for (std::size_t i = 0; i < 4; ++i) {
    seen.points[i] = mesh.point(vertices[i]) - eye;
    seen.values[i] = static_cast<double>(mesh.values[static_cast<std::size_t>(vertices[i])]);
    if (std::isnan(seen.values[i])) return false;
  }
  return true;
}

/// Draws all cells with a field.
void drawCells(const CellMesh& mesh, const std::vector<std::int32_t>& order, const gl::CellView& view,
               gl::CellRasterizer& rasterizer, ProjectionReport& report) {
  rasterizer.begin(view);
  const Vec3d* const along = view.camera.orthographic ? &view.camera.forward : nullptr;
  const auto numbers = static_cast<std::size_t>(cellNumbers(view.projection));
  std::atomic<std::int32_t> around_eye{-1};
  std::atomic<long long> drawn{0};
  for (std::size_t first = 0; first < order.size(); first += gl::CellRasterizer::kBatchCells) {
    const std::size_t count = std::min(gl::CellRasterizer::kBatchCells, order.size() - first);
    const gl::CellRasterizer::Batch batch = rasterizer.nextBatch();
    parallelFor(static_cast<int>(count), 1024, [&](int begin, int end) {
      long long here = 0;
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
        const std::int32_t cell = order[first + n];
        float* const vertices = batch.vertices + 4 * kFloatsOfVertex * n;
        SeenCell seen;
        if (!seenFrom(view.camera.eye, mesh, cell, seen)) {
          std::fill_n(vertices, 4 * kFloatsOfVertex, 0.0f);  // zero area
          continue;
        }
        if (!projectCell(seen, along, view.projection, vertices, batch.numbers + numbers * n))
          around_eye = cell;
        ++here;
      }
      drawn += here;
    });
    rasterizer.draw(count);
  }
  if (SeenCell seen; around_eye >= 0 && seenFrom(view.camera.eye, mesh, around_eye, seen)) {
    const gl::CellRasterizer::Batch batch = rasterizer.nextBatch();
    float exact[cellNumbers(CellProjection::exact)];
    projectCell(seen, nullptr, CellProjection::exact, batch.vertices, exact);
    projectCell(seen, nullptr, view.projection, batch.vertices, batch.numbers);
    rasterizer.drawAround(exact[4]);
  }
  report.cells = drawn;
  report.sent_bytes = rasterizer.sentFloats() * sizeof(float);
}

/// Depths of points on the pixels' rays.
template <class Real>
std::vector<Real> depthsOf(const std::vector<GroundHit>& hits, const CameraView& camera) {
  std::vector<Real> depths(hits.size(), std::numeric_limits<Real>::max());
  for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
    if (!hits[pixel].found) continue;
    const auto n = static_cast<int>(pixel);
    const auto ray = camera.rayThrough<double>(n % camera.size.width, n / camera.size.width);
    depths[pixel] = static_cast<Real>(hits[pixel].distance / length(ray.direction));
  }
  return depths;
}

}  // namespace

CellProjection parseCellProjection(const std::string& name) {
  return parseName<CellProjection>("projection of cells", name);
}
CellSorting parseCellSorting(const std::string& name) {
  return parseName<CellSorting>("order of cells", name);
}
Rasterizer parseRasterizer(const std::string& name) {
  return parseName<Rasterizer>("rasteriser", name);
}

bool CellRenderer::projectsOnCpu() {
  if (!impl_->rasterizer) impl_->rasterizer = std::make_unique<gl::CellRasterizer>();
  const std::string& device = impl_->rasterizer->device();
  constexpr const char* kSoftware[] = {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"};
  return std::any_of(std::begin(kSoftware), std::end(kSoftware),
                     [&](const char* name) { return device.find(name) != std::string::npos; });
}

Rasterizer CellRenderer::Impl::rasterizerFor(const ProjectionOptions& options, CellRenderer& renderer) const {
  const bool is_published =
      options.projection == CellProjection::published && scene.camera().projection == Projection::perspective;
  if (is_published && options.rasterizer == Rasterizer::tiles) {
    throw Error(
        ErrorCode::usage,
        "tiles of pixels support only the exact form of cell projection in perspective; the published form "
        "needs the rasterizer opengl");
  }
  if (options.rasterizer != Rasterizer::automatic) return options.rasterizer;
  if (is_published) return Rasterizer::opengl;
  if (caster) return Rasterizer::tiles;
  try {
    return renderer.projectsOnCpu() ? Rasterizer::tiles : Rasterizer::opengl;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::device) throw;
    return Rasterizer::tiles;
  }
}

Image CellRenderer::Impl::projectByOpenGl(const RaycastTask& task, const ProjectionOptions& options,
                                          const std::vector<GroundHit>& hits, ProjectionReport& report) {
  const gl::CellRasterizer::Use use(*rasterizer);
  const gl::CellView view{task.camera, options.projection, depthsOf<float>(hits, task.camera)};
  rasterizer->setTransfer(*transfer);
  report.device = rasterizer->device();
  Stopwatch watch;
  const CellOrder order = orderOf(cells, task.camera, options.sorting);
  report.cycles = order.cycles;
  report.order_ms = watch.lap_ms();
  drawCells(cells, order.cells, view, *rasterizer, report);
  Image image;
  rasterizer->fetch(image);
  report.draw_ms = watch.lap_ms();
  return image;
}

Image CellRenderer::Impl::projectByTiles(const RaycastTask& task, const ProjectionOptions& options,
                                         const std::vector<GroundHit>& hits, ProjectionReport& report) {
  const bool exact = scene.settings().exact;
  TileCast cast{
      {task.camera, DepthAxes(task.camera)}, !exact, depthsOf<double>(hits, task.camera), options.sorting};
  cast.task.through = exact ? 0 : 1 - static_cast<double>(kOpaqueEnough);
  report.device = toString(caster ? Backend::cuda : Backend::cpu);
  Stopwatch watch;
  Image image;
  if (caster) {
    const TileTimes times = caster->project(cast, image);
    report.cells = times.cells;
    report.cycles = times.cycles;
    report.draw_ms = watch.lap_ms() - times.order_ms;
    report.order_ms = times.order_ms;
    report.bin_ms = times.bin_ms;
    report.device_ms = times.bin_ms + times.draw_ms;
    return image;
  }
  const CellOrder order = orderOf(cells, task.camera, options.sorting);
  report.cycles = order.cycles;
  report.order_ms = watch.lap_ms();
  TileTask& tiles = cast.task;
  tiles.transfer = transfer->view();
  if (cast.table) tiles.psi = PsiTable::shared().lookup();
  tiles.end_depth = cast.end_depth.empty() ? nullptr : cast.end_depth.data();
  const TileProjection projection(tiles, cells, order.cells, options.sorting == CellSorting::visibility);
  report.bin_ms = watch.lap_ms();
  image = projection.composite();
  report.draw_ms = report.bin_ms + watch.lap_ms();
  report.cells = projection.cells();
  return image;
}

Image CellRenderer::project(ImageSize size, const ProjectionOptions& options, ProjectionReport* report) {
  Impl& impl = *impl_;
  ProjectionReport done;
  done.rasterizer = impl.rasterizerFor(options, *this);
  const bool by_opengl = done.rasterizer == Rasterizer::opengl;
  const bool on_gl_gpu = by_opengl && !projectsOnCpu();  // creates the context
  impl.scene.prepare();
  const RaycastTask task = impl.scene.task(size);
  const std::vector<GroundHit> ground = impl.ground(task);
  Image image = by_opengl ? impl.projectByOpenGl(task, options, ground, done)
                          : impl.projectByTiles(task, options, ground, done);
  if (on_gl_gpu) done.device_ms = impl.rasterizer->drawMs();
  for (std::size_t pixel = 0; pixel < ground.size(); ++pixel) {
    if (ground[pixel].found) image.pixels[pixel] = over(image.pixels[pixel], ground[pixel].color);
  }
  if (report != nullptr) *report = done;
  return image;
}

}  // namespace emscape::render
