/// Frames cast by the CPU.
#include <utility>

#include "base/large_array.h"
#include "base/stopwatch.h"
#include "render/cpu/raycast_cpu.h"
#include "render/patterns/adaptive.h"
#include "render/patterns/edges.h"
#include "render/scene/frame_caster.h"
#include "render/scene/ground_layer.h"
#include "render/scene/prepared_volume.h"

namespace emscape::render {
namespace {

/// Gives a picture a size, all pixels zero. @throws Stopped
void reset(Image& image, ImageSize size) {
  image = {};
  resizeInParts(image.pixels, static_cast<std::size_t>(size.count()));
  image.size = size;
}

class CpuFrameCaster : public FrameCaster {
 public:
  void setVolume(std::shared_ptr<const volume::DenseVolume> volume) override;
  void setVolume(std::shared_ptr<const volume::DeviceVolume> volume) override;
  std::size_t volumeBytes() const override { return 0; }
  FrameReport draw(const Scene& scene, const FramePlan& plan, ImageSize size, const StopFlag* stop) override;
  FrameReport restore(const Scene& scene, const StopFlag* stop, Edges edges) override;

  void bindTarget(Image& image) override { std::swap(picture_, image); }
  void unbindTarget(Image& image, const FrameReport& /*report*/) override { std::swap(picture_, image); }
  void fetch(Image& image) override { image = picture_; }
  void fetch(Image8& image) override { image = quantize(picture_); }

 private:
  RaycastTask prepare(const Scene& scene, ImageSize size);
  CpuCast castOf(const Scene& scene, const RaycastTask& prepared, bool shows_ground);
  bool cast(const Scene& scene, const std::vector<Lattice>& lattices, bool shows_ground, Image& image,
            FrameReport& report, const StopFlag* stop);
  bool drawAdaptive(const Scene& scene, const FramePlan& plan, bool shows_ground, Image& image,
                    FrameReport& report, const StopFlag* stop);
  bool castMissing(const Scene& scene, FrameReport& report, const StopFlag* stop);
  void smoothEdges(const Scene& scene, FrameReport& report, const StopFlag* stop);

  PreparedVolume volume_;
  SkipLevels skip_;
  bool skip_current_ = false;
  Scene::Versions seen_;  ///< versions from which the members here were derived

  GroundLayer ground_layer_;  ///< of the camera; its size is 0 x 0 when it must be computed again
  Image volume_layer_;        ///< only the volume, ended by the ground
  Image picture_;
  Pattern drawn_ = Pattern::full;  ///< of the last frame
  AdaptiveFrame adaptive_;
  Silhouette silhouette_;
};

void CpuFrameCaster::setVolume(std::shared_ptr<const volume::DenseVolume> volume) {
  volume_.set(std::move(volume));
  skip_current_ = false;
  ground_layer_.dropMap();
}

void CpuFrameCaster::setVolume(std::shared_ptr<const volume::DeviceVolume> volume) {
  setVolume(std::make_shared<const volume::DenseVolume>(volume->download()));
}

RaycastTask CpuFrameCaster::prepare(const Scene& scene, ImageSize size) {
  if (scene.versions().levels != seen_.levels) skip_current_ = false;
  if (!skip_current_) skip_ = skipLevels(scene.skipRule(), volume_.bricks());
  skip_current_ = true;
  if (scene.versions().view != seen_.view) ground_layer_.size = {};
  if (scene.versions().table != seen_.table || scene.versions().map != seen_.map) ground_layer_.dropMap();
  seen_ = scene.versions();
  if (scene.ground() && ground_layer_.size != size) ground_layer_.reset(size);
  if (scene.isMapped()) ground_layer_.beginMap();

  RaycastTask task = scene.task(size);
  task.volume = volume_.view();
  task.skip = {skip_.highest.data(), scene.settings().skip_empty ? skip_.levels.data() : nullptr,
               volume_.bricks().dims};
  task.volume_highest_f = task.transfer.normalized(volume_.highest());
  return task;
}

/// @param shows_ground  false: only the volume, ended by the ground
CpuCast CpuFrameCaster::castOf(const Scene& scene, const RaycastTask& prepared, bool shows_ground) {
  CpuCast cast{prepared, scene.settings().mode, scene.categorical(), scene.settings().plain};
  cast.ground = scene.ground() ? &ground_layer_ : nullptr;
  cast.shows_ground = shows_ground;
  return cast;
}

/// @return false if it was stopped
bool CpuFrameCaster::cast(const Scene& scene, const std::vector<Lattice>& lattices, bool shows_ground,
                          Image& image, FrameReport& report, const StopFlag* stop) {
  Stopwatch watch;
  const RaycastTask prepared = prepare(scene, image.size);
  const CpuCast cast = castOf(scene, prepared, shows_ground);
  for (const Lattice& lattice : lattices) {
    report.complete = castCpu(cast, lattice, image, stop, report.samples);
    if (!report.complete) break;
    report.rays += lattice.count();
  }
  report.cast_ms += watch.lap_ms();
  return report.complete;
}

/// @return false if it was stopped
bool CpuFrameCaster::drawAdaptive(const Scene& scene, const FramePlan& plan, bool shows_ground, Image& image,
                                  FrameReport& report, const StopFlag* stop) {
  Stopwatch all;
  const RaycastTask prepared = prepare(scene, image.size);
  const CpuCast cast = castOf(scene, prepared, shows_ground);
  long long hits = image.size.count();
  if (scene.ground() && shows_ground) {
    wholePicture(image.size, silhouette_);
  } else {
    findSilhouette(prepared.camera, prepared.volume.lower(), prepared.volume.upper(), silhouette_);
    hits = silhouette_.count();
    if (scene.transparentShowsNothing() && prepared.skip.levels != nullptr) {
      narrowSilhouette(prepared.camera, visibleBoxes(prepared.skip, prepared.volume.dims), silhouette_);
    }
  }
  const double max_rays = std::max(plan.ray_share * static_cast<double>(hits), 1.0);
  report.complete = adaptive_.draw(image, silhouette_, plan.tolerance_levels, max_rays,
                                   [&](const std::vector<Pixel>& pixels) {
                                     Stopwatch watch;
                                     const bool complete = castCpu(cast, pixels, image, stop, report.samples);
                                     report.rays += static_cast<long long>(pixels.size());
                                     report.cast_ms += watch.lap_ms();
                                     return complete;
                                   });
  report.interpolate_ms = all.lap_ms() - report.cast_ms;
  return report.complete;
}

FrameReport CpuFrameCaster::draw(const Scene& scene, const FramePlan& plan, ImageSize size,
                                 const StopFlag* stop) {
  if (picture_.size != size) reset(picture_, size);
  if (scene.versions().view != seen_.view) ground_layer_.size = {};
  drawn_ = plan.pattern;
  FrameReport report;
  report.pattern = plan.pattern;
  // If the ground is known everywhere, only the volume is interpolated, so that the ground stays sharp.
  const bool in_layers =
      scene.ground() && ground_layer_.size == size && ground_layer_.complete && plan.pattern != Pattern::full;
  if (in_layers && volume_layer_.size != size) reset(volume_layer_, size);
  Image& target = in_layers ? volume_layer_ : picture_;
  const bool complete =
      plan.pattern == Pattern::adaptive
          ? drawAdaptive(scene, plan, !in_layers, target, report, stop)
          : cast(scene, sourceLattices(plan.pattern, size), !in_layers, target, report, stop);
  if (!complete) return report;
  ground_layer_.complete |= plan.pattern == Pattern::full;
  Stopwatch watch;
  interpolate(plan.pattern, plan.interpolation, target);
  if (in_layers) {
    const RaycastTask prepared = prepare(scene, size);
    composeGround(castOf(scene, prepared, true), target, picture_);
  }
  report.interpolate_ms += watch.lap_ms();
  if (plan.pattern == Pattern::full && plan.edges == Edges::smooth) smoothEdges(scene, report, stop);
  return report;
}

FrameReport CpuFrameCaster::restore(const Scene& scene, const StopFlag* stop, Edges edges) {
  FrameReport report;
  report.pattern = drawn_;
  if (!castMissing(scene, report, stop)) return report;
  ground_layer_.complete = true;
  if (edges == Edges::smooth) smoothEdges(scene, report, stop);
  return report;
}

/// Casts the pixels at edges of the exact picture again.
void CpuFrameCaster::smoothEdges(const Scene& scene, FrameReport& report, const StopFlag* stop) {
  Stopwatch watch;
  const std::vector<Pixel> edges = edgePixels(picture_);
  const RaycastTask prepared = prepare(scene, picture_.size);
  report.complete = castEdges(castOf(scene, prepared, true), edges, picture_, stop, report.samples);
  report.rays += kEdgeRays * static_cast<long long>(edges.size());
  report.cast_ms += watch.lap_ms();
}

/// Casts the pixels that the last frame left out. @return false if it was stopped
bool CpuFrameCaster::castMissing(const Scene& scene, FrameReport& report, const StopFlag* stop) {
  if (drawn_ != Pattern::adaptive) {
    return cast(scene, missingLattices(drawn_, picture_.size), true, picture_, report, stop);
  }
  Stopwatch watch;
  const RaycastTask prepared = prepare(scene, picture_.size);
  const std::vector<Pixel>& missing = adaptive_.missing();
  report.complete = castCpu(castOf(scene, prepared, true), missing, picture_, stop, report.samples);
  if (report.complete) report.rays = static_cast<long long>(missing.size());
  report.cast_ms = watch.lap_ms();
  return report.complete;
}

}  // namespace

std::unique_ptr<FrameCaster> makeCpuCaster() {
  return std::make_unique<CpuFrameCaster>();
}

}  // namespace emscape::render
