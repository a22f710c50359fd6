#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/stopwatch.h"
#include "render/cpu/raycast_cpu.h"
#include "render/transfer_table.h"

namespace emscape::render {
namespace {

void requireRange(const char* name, double value, double least, double largest) {
  if (!(value >= least && value <= largest)) {
    throw Error(ErrorCode::bad_input, fmt::format("{} {}: expected {}..{}", name, value, least, largest));
  }
}

/// Drawn positions to the index space of a grid, axis by axis.
struct IndexSpace {
  Vec3d origin_m;   ///< drawn position of the centre of voxel (0, 0, 0)
  Vec3d spacing_m;  ///< of voxels as drawn

  IndexSpace(const volume::Grid& grid, const SceneBox& box)
      : origin_m(box.toDrawn(grid.first_center_m)), spacing_m(grid.spacing_m) {
    spacing_m.z *= box.vertical_exaggeration;
  }
  Vec3d vector(const Vec3d& drawn) const {
    return {drawn.x / spacing_m.x, drawn.y / spacing_m.y, drawn.z / spacing_m.z};
  }
  Vec3d position(const Vec3d& drawn_m) const { return vector(drawn_m - origin_m); }
};

CameraView viewOf(const Camera& camera, const IndexSpace& space, ImageSize size) {
  CameraView view;
  view.eye = space.position(camera.eye_m);
  view.forward = space.vector(camera.forward);
  view.right = space.vector(camera.right);
  view.up = space.vector(camera.up);
  view.half_height = camera.half_height;
  view.shift_x = camera.shift_x;
  view.shift_y = camera.shift_y;
  view.orthographic = camera.projection == Projection::orthographic;
  view.size = size;
  return view;
}

int maskedBelow(const volume::DenseVolume& volume) {
  if (volume.first_valid_k.empty()) return 0;
  return *std::max_element(volume.first_valid_k.begin(), volume.first_valid_k.end());
}

void checkVolume(const volume::DenseVolume& volume) {
  const Dims& dims = volume.grid.dims;
  if (dims.x < 1 || dims.y < 1 || dims.z < 1 ||
      dims.count() != static_cast<long long>(volume.values.size())) {
    throw Error(ErrorCode::bad_input, fmt::format("volume of {} x {} x {} voxels holds {} values", dims.x,
                                                  dims.y, dims.z, volume.values.size()));
  }
}

}  // namespace

struct Renderer::Impl {
  std::shared_ptr<const volume::DenseVolume> volume;
  std::shared_ptr<const HeightField> height_field;
  TransferFunction function;
  Camera camera;
  RenderSettings settings;

  // Prepared from the above; empty: to be prepared before the next cast.
  std::optional<volume::Bricks> bricks;
  std::optional<GroundSurface> ground;
  std::optional<TransferTable> table;
  std::vector<std::uint8_t> transparent;
  bool bricks_current = false;
  int masked_below = 0;
  float highest = 0;

  Pattern drawn = Pattern::full;  ///< of the last frame

  const volume::DenseVolume& requireVolume() const {
    if (!volume) throw Error(ErrorCode::other, "Renderer: no volume is set");
    return *volume;
  }

  SceneBox box() const { return sceneBoxOf(requireVolume().grid, settings.vertical_exaggeration); }

  void prepareGround() {
    if (height_field && !ground) ground.emplace(*height_field, requireVolume().grid, box());
  }

  void prepareBricks() {
    if (bricks_current) return;
    if (bricks) {
      bricks->update(*volume);
    } else {
      bricks.emplace(*volume);
    }
    masked_below = maskedBelow(*volume);
    const volume::BricksView view = bricks->view();
    highest = -std::numeric_limits<float>::infinity();
    for (long long i = 0; i < view.dims.count(); ++i) highest = std::max(highest, view.ranges[i].max);
    transparent.clear();
    bricks_current = true;
  }

  void prepareTransfer() {
    if (!table) {
      table.emplace(function, settings.step_voxels);
      transparent.clear();
    }
    if (transparent.empty()) transparent = table->transparentBricks(bricks->view());
  }

  RaycastTask task(ImageSize size) {
    requireVolume();
    prepareGround();
    prepareBricks();
    prepareTransfer();
    RaycastTask task;
    task.camera = viewOf(camera, IndexSpace(volume->grid, box()), size);
    task.volume = {volume->values.data(), volume->grid.dims,
                   masked_below > 0 ? volume->first_valid_k.data() : nullptr, masked_below};
    task.transfer = table->view();
    if (settings.skip_empty) {
      const volume::BricksView view = bricks->view();
      task.skip = {view.ranges, transparent.data(), view.dims, view.edge};
    }
    if (ground) task.ground = ground->view();
    task.step_voxels = static_cast<float>(settings.step_voxels);
    task.mida_gamma = static_cast<float>(settings.mida_gamma);
    task.volume_highest_f = task.transfer.normalized(highest);
    task.exact = settings.exact;
    return task;
  }

  /// @return false if it was stopped
  bool cast(const std::vector<Lattice>& lattices, Image& image, FrameReport& report, const StopFlag* stop) {
    Stopwatch watch;
    const RaycastTask prepared = task(image.size);
    for (const Lattice& lattice : lattices) {
      report.complete = castCpu(prepared, settings.mode, volume->info.categorical, lattice, image, stop);
      if (!report.complete) break;
      report.rays += lattice.count();
    }
    report.cast_ms = watch.lap_ms();
    return report.complete;
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

void Renderer::setVolume(std::shared_ptr<const volume::DenseVolume> volume) {
  if (!volume) throw Error(ErrorCode::other, "Renderer: no volume is given");
  checkVolume(*volume);
  if (!impl_->volume || impl_->volume->grid != volume->grid) impl_->ground.reset();
  impl_->volume = std::move(volume);
  impl_->bricks_current = false;
}

void Renderer::setHeightField(std::shared_ptr<const HeightField> height_field) {
  impl_->height_field = std::move(height_field);
  impl_->ground.reset();
  if (impl_->volume) impl_->prepareGround();
}

void Renderer::setTransferFunction(const TransferFunction& function) {
  impl_->function = function;
  impl_->table.reset();
}

void Renderer::setCamera(const Camera& camera) {
  impl_->camera = camera;
}

void Renderer::setSettings(const RenderSettings& settings) {
  requireRange("step (voxels)", settings.step_voxels, 0.05, 10);
  requireRange("MIDA gamma", settings.mida_gamma, -1, 1);
  requireRange("vertical exaggeration", settings.vertical_exaggeration, 0, 1000);
  if (settings.step_voxels != impl_->settings.step_voxels) impl_->table.reset();
  if (settings.vertical_exaggeration != impl_->settings.vertical_exaggeration) impl_->ground.reset();
  impl_->settings = settings;
}

const RenderSettings& Renderer::settings() const {
  return impl_->settings;
}
const TransferFunction& Renderer::transferFunction() const {
  return impl_->function;
}
const Camera& Renderer::camera() const {
  return impl_->camera;
}
SceneBox Renderer::sceneBox() const {
  return impl_->box();
}

bool Renderer::isHidden(const Vec3d& frame_m) const {
  if (!impl_->height_field) return false;
  impl_->prepareGround();
  const SceneBox box = impl_->box();
  const IndexSpace space(impl_->volume->grid, box);
  const Vec3d target = space.position(box.toDrawn(frame_m));
  Vec3d eye = space.position(impl_->camera.eye_m);
  if (impl_->camera.projection == Projection::orthographic) {
    const Vec3d forward = normalized(space.vector(impl_->camera.forward));
    eye = target - forward * (length(target - eye) + 1.0);
  }
  const double distance = length(target - eye);
  if (!(distance > 0)) return false;
  const Ray ray{eye, (target - eye) / distance};
  const GroundView ground = impl_->ground->view();
  const RayInterval over_ground = clip(ray, ground.lower, ground.upper);
  if (!(over_ground.end > over_ground.begin)) return false;
  const GroundHit hit = ground.firstHit(ray.origin, ray.direction, over_ground.begin, over_ground.end);
  // A marker that stands on the ground is not hidden by what it stands on.
  constexpr double kStandsOn_voxels = 0.5;
  return hit.found && hit.distance < distance - kStandsOn_voxels;
}

FrameReport Renderer::draw(const FramePlan& plan, ImageSize size, Image& image, const StopFlag* stop) {
  if (image.size != size) image = Image(size);
  impl_->drawn = plan.pattern;
  FrameReport report;
  report.pattern = plan.pattern;
  if (!impl_->cast(sourceLattices(plan.pattern, size), image, report, stop)) return report;
  Stopwatch watch;
  interpolate(plan.pattern, plan.interpolation, image);
  report.interpolate_ms = watch.lap_ms();
  return report;
}

FrameReport Renderer::restore(Image& image, const StopFlag* stop) {
  FrameReport report;
  report.pattern = impl_->drawn;
  impl_->cast(missingLattices(impl_->drawn, image.size), image, report, stop);
  return report;
}

Image Renderer::render(ImageSize size, const FramePlan& plan, FrameReport* report) {
  Image image(size);
  const FrameReport drawn = draw(plan, size, image);
  if (report != nullptr) *report = drawn;
  return image;
}

}  // namespace emscape::render
