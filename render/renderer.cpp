#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "render/cpu/raycast_cpu.h"
#include "render/ground_layer.h"
#include "render/ready_volume.h"
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

/// The light stands a little above and to the left of the viewer.
ShadingView shadingOf(const Camera& camera, const IndexSpace& space) {
  constexpr double kLeft = 0.3, kAbove = 0.4;
  const Vec3d& spacing = space.spacing_m;
  ShadingView shading;
  shading.voxel = vecCast<float>(spacing / std::max({spacing.x, spacing.y, spacing.z}));
  shading.to_light = vecCast<float>(normalized(camera.up * kAbove - camera.right * kLeft - camera.forward));
  return shading;
}

}  // namespace

struct Renderer::Impl {
  ReadyVolume volume;
  std::shared_ptr<const HeightField> height_field;
  TransferFunction function;
  Camera camera;
  RenderSettings settings;

  // Prepared from the above; empty: to be prepared before the next cast.
  std::optional<GroundSurface> ground;
  std::optional<TransferTable> table;
  SkipLevels skip;
  bool skip_current = false;

  GroundLayer ground_layer;       ///< of the camera; its size is 0 x 0 when it must be computed anew
  Image volume_layer;             ///< the volume alone, cut off by the ground
  Pattern drawn = Pattern::full;  ///< of the last frame
  AdaptiveFrame adaptive;
  Silhouette silhouette;

  const volume::Grid& grid() const {
    if (!volume.isSet()) throw Error(ErrorCode::other, "Renderer: no volume is set");
    return volume.volume().grid;
  }

  SceneBox box() const { return sceneBoxOf(grid(), settings.vertical_exaggeration); }

  void dropGround() {
    ground.reset();
    ground_layer.size = {};
  }

  void prepareGround() {
    if (height_field && !ground) ground.emplace(*height_field, grid(), box());
  }

  void prepareTransfer() {
    if (!table) {
      table.emplace(function, settings.step_voxels);
      skip_current = false;
    }
    if (!skip_current) {
      skip = table->skipLevels(volume.bricks(), settings.mode, static_cast<float>(isoValue()));
    }
    skip_current = true;
  }

  double isoValue() const {
    return std::isnan(settings.iso_value) ? 0.5 * (function.lowest() + function.highest())
                                          : settings.iso_value;
  }

  IsoView iso() const {
    const double value = isoValue();
    const Rgb color = function.color(value);
    return {static_cast<float>(value), static_cast<float>(settings.iso_opacity), color.r, color.g, color.b};
  }

  RaycastTask task(ImageSize size) {
    const volume::Grid& shown = grid();
    prepareGround();
    prepareTransfer();
    RaycastTask task;
    const IndexSpace space(shown, box());
    task.camera = viewOf(camera, space, size);
    task.volume = volume.view();
    task.transfer = table->view();
    task.skip = {skip.highest.data(), settings.skip_empty ? skip.levels.data() : nullptr,
                 volume.bricks().dims};
    task.shading = shadingOf(camera, space);
    task.shading.shades_fog =
        settings.shading && settings.mode != CompositingMode::mip && !volume.volume().info.categorical;
    task.iso = iso();
    if (ground) {
      task.ground = ground->view();
      if (ground_layer.size != size) ground_layer.reset(size);
    }
    task.step_voxels = static_cast<float>(settings.step_voxels);
    task.mida_gamma = static_cast<float>(settings.mida_gamma);
    task.volume_highest_f = task.transfer.normalized(volume.highest());
    task.exact = settings.exact;
    return task;
  }

  /// @param shows_ground  false: the volume alone, cut off by the ground
  CpuCast castOf(const RaycastTask& prepared, bool shows_ground) {
    CpuCast cast{prepared, settings.mode, volume.volume().info.categorical, settings.plain};
    cast.ground = ground ? &ground_layer : nullptr;
    cast.shows_ground = shows_ground;
    return cast;
  }

  /// @return false if it was stopped
  bool cast(const std::vector<Lattice>& lattices, bool shows_ground, Image& image, FrameReport& report,
            const StopFlag* stop) {
    Stopwatch watch;
    const RaycastTask prepared = task(image.size);
    const CpuCast cast = castOf(prepared, shows_ground);
    for (const Lattice& lattice : lattices) {
      report.complete = castCpu(cast, lattice, image, stop, report.samples);
      if (!report.complete) break;
      report.rays += lattice.count();
    }
    report.cast_ms += watch.lap_ms();
    return report.complete;
  }

  /// Whether rays that meet transparent samples alone are transparent.
  bool transparentShowsNothing() const {
    return settings.mode == CompositingMode::dvr ||
           (settings.mode == CompositingMode::mida && settings.mida_gamma <= 0);
  }

  /// @return false if it was stopped
  bool drawAdaptive(const FramePlan& plan, bool shows_ground, Image& image, FrameReport& report,
                    const StopFlag* stop) {
    Stopwatch all;
    const RaycastTask prepared = task(image.size);
    const CpuCast cast = castOf(prepared, shows_ground);
    long long hits = image.size.count();
    if (ground && shows_ground) {
      wholePicture(image.size, silhouette);
    } else {
      findSilhouette(prepared.camera, prepared.volume.lower(), prepared.volume.upper(), silhouette);
      hits = silhouette.count();
      if (transparentShowsNothing() && prepared.skip.levels != nullptr) {
        narrowSilhouette(prepared.camera, visibleBoxes(prepared.skip, prepared.volume.dims), silhouette);
      }
    }
    const double most_rays = std::max(plan.ray_share * static_cast<double>(hits), 1.0);
    report.complete = adaptive.draw(
        image, silhouette, plan.tolerance_levels, most_rays, [&](const std::vector<Pixel>& pixels) {
          Stopwatch watch;
          const bool complete = castCpu(cast, pixels, image, stop, report.samples);
          report.rays += static_cast<long long>(pixels.size());
          report.cast_ms += watch.lap_ms();
          return complete;
        });
    report.interpolate_ms = all.lap_ms() - report.cast_ms;
    return report.complete;
  }

  /// Casts what the last frame left out. @return false if it was stopped
  bool castMissing(Image& image, FrameReport& report, const StopFlag* stop) {
    if (drawn != Pattern::adaptive) {
      return cast(missingLattices(drawn, image.size), true, image, report, stop);
    }
    Stopwatch watch;
    const RaycastTask prepared = task(image.size);
    const std::vector<Pixel>& missing = adaptive.missing();
    report.complete = castCpu(castOf(prepared, true), missing, image, stop, report.samples);
    if (report.complete) report.rays = static_cast<long long>(missing.size());
    report.cast_ms = watch.lap_ms();
    return report.complete;
  }

  /// The ground behind every pixel of the volume's layer.
  void composeGround(Image& image) const {
    constexpr int kRowGrain = 16;
    parallelFor(image.size.height, kRowGrain, [&](int begin, int end) {
      const std::size_t last = ground_layer.index(0, end);
      for (std::size_t pixel = ground_layer.index(0, begin); pixel < last; ++pixel) {
        image.pixels[pixel] = ground_layer.behind(volume_layer.pixels[pixel], pixel);
      }
    });
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

void Renderer::setVolume(std::shared_ptr<const volume::DenseVolume> volume) {
  if (!volume) throw Error(ErrorCode::other, "Renderer: no volume is given");
  if (!impl_->volume.isSet() || impl_->volume.volume().grid != volume->grid) impl_->dropGround();
  impl_->volume.set(std::move(volume));
  impl_->skip_current = false;
}

void Renderer::setHeightField(std::shared_ptr<const HeightField> height_field) {
  impl_->height_field = std::move(height_field);
  impl_->dropGround();
  if (impl_->volume.isSet()) impl_->prepareGround();
}

void Renderer::setTransferFunction(const TransferFunction& function) {
  impl_->function = function;
  impl_->table.reset();
}

void Renderer::setCamera(const Camera& camera) {
  impl_->camera = camera;
  impl_->ground_layer.size = {};
}

void Renderer::setSettings(const RenderSettings& settings) {
  requireRange("step (voxels)", settings.step_voxels, 0.05, 10);
  requireRange("MIDA gamma", settings.mida_gamma, -1, 1);
  requireRange("vertical exaggeration", settings.vertical_exaggeration, 0, 1000);
  requireRange("iso opacity", settings.iso_opacity, 0, 1);
  if (std::isinf(settings.iso_value)) throw Error(ErrorCode::bad_input, "iso value: must be finite");
  if (settings.step_voxels != impl_->settings.step_voxels) impl_->table.reset();
  if (settings.vertical_exaggeration != impl_->settings.vertical_exaggeration) impl_->dropGround();
  if (settings.mode != impl_->settings.mode || settings.iso_value != impl_->settings.iso_value) {
    impl_->skip_current = false;
  }
  impl_->settings = settings;
}

const RenderSettings& Renderer::settings() const {
  return impl_->settings;
}
const TransferFunction& Renderer::transferFunction() const {
  return impl_->function;
}
double Renderer::isoValue() const {
  return impl_->isoValue();
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
  const IndexSpace space(impl_->grid(), box);
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
  // Where the ground is known everywhere, only the volume is interpolated: the ground stays sharp.
  const bool in_layers = impl_->ground && impl_->ground_layer.size == size && impl_->ground_layer.complete &&
                         plan.pattern != Pattern::full;
  if (in_layers && impl_->volume_layer.size != size) impl_->volume_layer = Image(size);
  Image& target = in_layers ? impl_->volume_layer : image;
  const bool complete =
      plan.pattern == Pattern::adaptive
          ? impl_->drawAdaptive(plan, !in_layers, target, report, stop)
          : impl_->cast(sourceLattices(plan.pattern, size), !in_layers, target, report, stop);
  if (!complete) return report;
  impl_->ground_layer.complete |= plan.pattern == Pattern::full;
  Stopwatch watch;
  interpolate(plan.pattern, plan.interpolation, target);
  if (in_layers) impl_->composeGround(image);
  report.interpolate_ms += watch.lap_ms();
  return report;
}

FrameReport Renderer::restore(Image& image, const StopFlag* stop) {
  FrameReport report;
  report.pattern = impl_->drawn;
  if (impl_->castMissing(image, report, stop)) impl_->ground_layer.complete = true;
  return report;
}

Image Renderer::render(ImageSize size, const FramePlan& plan, FrameReport* report) {
  Image image(size);
  const FrameReport drawn = draw(plan, size, image);
  if (report != nullptr) *report = drawn;
  return image;
}

}  // namespace emscape::render
