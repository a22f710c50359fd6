/// Frames cast by the GPU.
#include <algorithm>
#include <numeric>
#include <utility>

#include "base/cuda/cuda_memory.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"
#include "render/cuda/device_scene.h"
#include "render/cuda/kernels.h"
#include "render/cuda/picture_memory.h"
#include "render/patterns/adaptive_tolerance.h"
#include "render/patterns/edges.h"
#include "render/scene/frame_caster.h"
#include "render/scene/silhouette.h"
#include "volume/cuda/device_storage.h"

namespace emscape::render {
namespace {

using cuda::CastLaunch;
using cuda::Sampling;
using emscape::cuda::Buffer;
using emscape::cuda::check;

/// Approximate number of samples of one launch: a stop waits for one launch at most. A restoration is cast in
/// smaller steps, so that it can be stopped quickly.
constexpr double kFrameSamples = 1 << 30;
constexpr double kRestorationSamples = 1 << 27;

/// What is behind the volume in each pixel, and where the samples of its ray begin and end.
struct Behind {
  Buffer<float> ground_distances;
  Buffer<float4> ground_colors;
  Buffer<bool> ground_is_surface;
  Buffer<float4> mapped_colors;  ///< of the ground, with the map layer
  Buffer<float> cut_begins, cut_limits, cut_distances;
  Buffer<float4> cut_colors;
};

class CudaFrameCaster : public FrameCaster {
 public:
  explicit CudaFrameCaster(volume::VoxelPrecision precision) : precision_(precision) {}

  void setVolume(std::shared_ptr<const volume::DenseVolume> volume) override;
  void setVolume(std::shared_ptr<const volume::DeviceVolume> volume) override;
  FrameReport draw(const Scene& scene, const FramePlan& plan, ImageSize size, const StopFlag* stop) override;
  FrameReport restore(const Scene& scene, const StopFlag* stop, Edges edges) override;

  std::size_t volumeBytes() const override { return volume_ ? volume_->bytes() : 0; }

  void bindTarget(Image& /*image*/) override {}
  void unbindTarget(Image& image, const FrameReport& report) override {
    if (report.complete) fetch(image);
  }
  void fetch(Image& image) override;
  void fetch(Image8& image) override;
  std::shared_ptr<const DevicePicture> compose(const OverlayLayers& layers) override;

 private:
  CastLaunch begin(const Scene& scene, ImageSize size, const StopFlag* stop, double max_samples);
  bool isStopped(const StopFlag* stop);
  void beginTime();
  CastLaunch prepare(const Scene& scene, ImageSize size);
  void findBehind(const Scene& scene, bool has_ground, const bool* only, Behind& behind, CastLaunch& launch,
                  cuda::Layers& layers);
  void findInside(const Scene& scene, ImageSize size);
  void smoothEdges(const Scene& scene, const CastLaunch& launch, const StopFlag* stop, FrameReport& report);
  void finish(FrameReport& report);
  bool castLattices(const CastLaunch& launch, const std::vector<Lattice>& lattices, const StopFlag* stop,
                    FrameReport& report);
  bool castAdaptive(const CastLaunch& launch, const FramePlan& plan, const StopFlag* stop);
  void countAdaptive(const FramePlan& plan, FrameReport& report);
  void cast(const CastLaunch& launch) const { castPixels(launch, mode_, sampling_, stream_); }

  const volume::VoxelPrecision precision_;
  emscape::cuda::Stream stream_;
  emscape::cuda::TimeMark begin_, end_;  ///< of the last frame, or restoration
  bool is_begun_ = false;                ///< begin_ is recorded
  long long max_rays_ = 0;               ///< of a launch
  bool is_cast_ = false;                 ///< some launch of the frame was made

  volume::DeviceVolumeRing copies_;  ///< of volumes from the host's memory
  std::shared_ptr<const volume::DeviceVolume> volume_;
  cuda::DeviceScene scene_;
  CompositingMode mode_ = CompositingMode::dvr;
  Sampling sampling_ = Sampling::filtered;

  cuda::Layers layers_;  ///< of the last drawn picture
  Buffer<unsigned> next_tile_;
  Buffer<float4> layer_;
  Buffer<float4> picture_;
  Buffer<uchar4> picture8_;
  Buffer<std::uint32_t> behind_, front_;  ///< layers of labels
  /// Composed pictures, including those in use elsewhere.
  std::vector<std::shared_ptr<cuda::PictureMemory>> finished_;

  /// Results for one view: the ground, and the pixels whose rays meet the box.
  struct View {
    unsigned version = 0;
    ImageSize size;
    bool holds(unsigned scene_version, ImageSize scene_size) const {
      return version == scene_version && size == scene_size;
    }
  };
  View ground_view_, inside_view_;
  Behind seen_;  ///< behind the volume
  Silhouette silhouette_;
  Buffer<Span> inside_;

  bool is_smooth_ = false;  ///< the pixels at edges have their means
  Buffer<std::uint8_t> contrasts_;
  Buffer<unsigned> contrast_counts_;
  Buffer<bool> is_edge_;
  Buffer<float4> edge_layer_, edge_means_;
  Behind seen_at_edges_;  ///< by one of their rays

  FramePlan drawn_;
  ToleranceController hold_;
  double tolerance_levels_ = 0;  ///< of the last adaptive frame
  Buffer<bool> predicted_;       ///< pixels of the last adaptive frame
  Buffer<unsigned> rays_;        ///< one number: rays of all adaptive frames, modulo 2^32
  unsigned rays_before_ = 0;     ///< the same before the last frame
  long long missing_rays_ = 0;   ///< those that the last adaptive frame predicted
};

void CudaFrameCaster::setVolume(std::shared_ptr<const volume::DenseVolume> volume) {
  auto copy = copies_.next(volume->grid, precision_);
  copy->upload(*volume);
  setVolume(std::shared_ptr<const volume::DeviceVolume>(std::move(copy)));
}

void CudaFrameCaster::setVolume(std::shared_ptr<const volume::DeviceVolume> volume) {
  constexpr auto kSparse = volume::VoxelPrecision::sparse32;
  if (precision_ == kSparse && volume->precision() != kSparse) {
    return setVolume(std::make_shared<const volume::DenseVolume>(volume->download()));
  }
  volume_ = std::move(volume);
  scene_.volumeChanged();
}

/// Number of rays with at most this number of samples, even if each crosses the volume along its diagonal.
long long raysFor(const CastLaunch& launch, double samples) {
  const Dims& dims = launch.task.volume.dims;
  const double longest =
      length(Vec3d{static_cast<double>(dims.x), static_cast<double>(dims.y), static_cast<double>(dims.z)});
  return std::max<long long>(static_cast<long long>(samples * launch.task.step_voxels / longest), 1);
}

/// The time of a frame or restoration begins with its first work on the GPU, except the few kilobytes of
/// findInside().
void CudaFrameCaster::beginTime() {
  if (!is_begun_) begin_.record(stream_);
  is_begun_ = true;
}

/// Called before each casting launch: waits for the previous one, so that a stop waits for at most one
/// launch.
bool CudaFrameCaster::isStopped(const StopFlag* stop) {
  if (stop == nullptr) return false;
  if (is_cast_) stream_.wait();
  is_cast_ = true;
  return stop->load(std::memory_order_relaxed);
}

/// @param max_samples  of a launch that a stop waits for
CastLaunch CudaFrameCaster::begin(const Scene& scene, ImageSize size, const StopFlag* stop,
                                  double max_samples) {
  volume_->storage().beginReading(stream_);
  const bool is_prepared = scene_.isCurrent(scene) && !scene.isCut() && !scene.isMapped() &&
                           (!scene.ground() || ground_view_.holds(scene.versions().view, size));
  is_begun_ = is_cast_ = is_smooth_ = false;
  if (!is_prepared) beginTime();
  const CastLaunch launch = prepare(scene, size);
  max_rays_ = stop != nullptr ? raysFor(launch, max_samples) : size.count();
  return launch;
}

CastLaunch CudaFrameCaster::prepare(const Scene& scene, ImageSize size) {
  scene_.update(scene, volume_->storage(), stream_);
  mode_ = scene.settings().mode;
  const bool accurate = scene.settings().plain || mode_ == CompositingMode::iso;
  if (volume_->precision() == volume::VoxelPrecision::sparse32) {
    sampling_ = scene.categorical() ? Sampling::sparse_nearest
                : accurate          ? Sampling::sparse_accurate
                                    : Sampling::sparse;
  } else {
    sampling_ = scene.categorical() ? Sampling::nearest : accurate ? Sampling::accurate : Sampling::filtered;
  }
  cuda::Layer layer;
  layer.size = size;
  layer_.resize(layer.length());
  layer.pixels = layer_.data();
  picture8_.resize(static_cast<std::size_t>(size.count()));
  CastLaunch launch = scene_.launch(scene, volume_->storage(), sampling_, size);
  if (next_tile_.size() == 0) {
    next_tile_.resize(1);
    check(cudaMemsetAsync(next_tile_.data(), 0, sizeof(unsigned), stream_), "cudaMemset");
  }
  launch.next_tile = next_tile_.data();
  launch.layer = layer;
  layers_ = {};
  layers_.size = size;
  layers_.volume = layer;
  findBehind(scene, ground_view_.holds(scene.versions().view, size), nullptr, seen_, launch, layers_);
  if (scene.ground()) ground_view_ = {scene.versions().view, size};
  return launch;
}

/// The map layer and the sections show the volume's values: they are computed for every frame.
/// @param has_ground  the ground is known  @param only  see castGround()
/// @param launch, layers  receive what is behind the volume
void CudaFrameCaster::findBehind(const Scene& scene, bool has_ground, const bool* only, Behind& behind,
                                 CastLaunch& launch, cuda::Layers& layers) {
  const std::size_t pixels = static_cast<std::size_t>(launch.task.camera.size.count());
  launch.limits = launch.begins = nullptr;
  layers.ground_distances = nullptr;
  layers.ground_colors = nullptr;
  if (scene.ground()) {
    if (!has_ground) {
      behind.ground_distances.resize(pixels);
      behind.ground_colors.resize(pixels);
      behind.ground_is_surface.resize(pixels);
      cuda::castGround(launch.task, only, behind.ground_distances.data(), behind.ground_colors.data(),
                       behind.ground_is_surface.data(), stream_);
    }
    launch.limits = behind.ground_distances.data();
    layers.ground_distances = behind.ground_distances.data();
    layers.ground_colors = behind.ground_colors.data();
  }
  RaycastTask task = launch.task;
  task.volume.texture = volume_->storage().pointTexture();
  if (scene.isMapped()) {
    behind.mapped_colors.resize(pixels);
    cuda::castMap(task, sampling_, only,
                  {behind.ground_distances.data(), behind.ground_colors.data(),
                   behind.ground_is_surface.data(), behind.mapped_colors.data()},
                  stream_);
    layers.ground_colors = behind.mapped_colors.data();
  }
  if (!scene.isCut()) return;
  behind.cut_begins.resize(pixels);
  behind.cut_limits.resize(pixels);
  behind.cut_distances.resize(pixels);
  behind.cut_colors.resize(pixels);
  cuda::castCut(task, sampling_, only,
                {layers.ground_distances, layers.ground_colors, behind.cut_begins.data(),
                 behind.cut_limits.data(), behind.cut_distances.data(), behind.cut_colors.data()},
                stream_);
  launch.begins = behind.cut_begins.data();
  launch.limits = behind.cut_limits.data();
  layers.ground_distances = behind.cut_distances.data();
  layers.ground_colors = behind.cut_colors.data();
}

/// Computed by the host before a frame's time begins, because the GPU would wait for it. Widened, because the
/// GPU's quotients are not exact in the last two bits of a double, so that a ray may meet the box on only one
/// processor.
void CudaFrameCaster::findInside(const Scene& scene, ImageSize size) {
  const unsigned version = scene.versions().view;
  if (inside_view_.holds(version, size)) return;
  VolumeView volume;
  volume.dims = scene.grid().dims;
  findWideSilhouette(scene.task(size).camera, volume.lower(), volume.upper(), silhouette_);
  inside_.upload(silhouette_.rows, stream_);
  inside_view_ = {version, size};
}

FrameReport CudaFrameCaster::draw(const Scene& scene, const FramePlan& plan, ImageSize size,
                                  const StopFlag* stop) {
  FrameReport report;
  report.pattern = plan.pattern;
  drawn_ = plan;
  if (size.count() == 0) return report;
  if (plan.pattern == Pattern::adaptive) findInside(scene, size);
  const CastLaunch launch = begin(scene, size, stop, kFrameSamples);
  layers_.pattern = plan.pattern;
  layers_.interpolation = plan.interpolation;
  if (plan.pattern == Pattern::adaptive) {
    report.complete = castAdaptive(launch, plan, stop);
  } else {
    report.complete = castLattices(launch, sourceLattices(plan.pattern, size), stop, report);
  }
  if (plan.pattern == Pattern::full && plan.edges == Edges::smooth) smoothEdges(scene, launch, stop, report);
  finish(report);
  if (plan.pattern == Pattern::adaptive && report.complete) countAdaptive(plan, report);
  return report;
}

FrameReport CudaFrameCaster::restore(const Scene& scene, const StopFlag* stop, Edges edges) {
  FrameReport report;
  report.pattern = drawn_.pattern;
  const ImageSize size = layers_.size;
  if (size.count() == 0) return report;
  CastLaunch launch = begin(scene, size, stop, kRestorationSamples);
  if (drawn_.pattern == Pattern::adaptive) {
    launch.predicted = predicted_.data();
    report.complete = castLattices(launch, sourceLattices(Pattern::full, size), stop, report);
    report.rays = missing_rays_;
  } else {
    report.complete = castLattices(launch, missingLattices(drawn_.pattern, size), stop, report);
  }
  launch.predicted = nullptr;
  if (edges == Edges::smooth) smoothEdges(scene, launch, stop, report);
  finish(report);
  return report;
}

/// Casts the pixels at edges of the exact picture again.
void CudaFrameCaster::smoothEdges(const Scene& scene, const CastLaunch& launch, const StopFlag* stop,
                                  FrameReport& report) {
  if (!report.complete) return;
  const ImageSize size = layers_.size;
  const std::size_t pixels = picture8_.size();
  beginTime();
  showPicture8(layers_, picture8_.data(), stream_);
  contrasts_.resize(pixels);
  ContrastCounts counts{};
  contrast_counts_.resize(counts.size());
  check(cudaMemsetAsync(contrast_counts_.data(), 0, sizeof counts, stream_), "cudaMemset");
  cuda::findContrasts(size, picture8_.data(), contrasts_.data(), contrast_counts_.data(), stream_);
  contrast_counts_.download(counts.data(), stream_);
  const int least = edgeContrast_levels(counts, size);
  const long long edges = std::accumulate(counts.begin() + least, counts.end(), 0LL);
  if (edges == 0) return;
  is_edge_.resize(pixels);
  edge_means_.resize(pixels);
  edge_layer_.resize(layer_.size());
  cuda::markEdges(size, contrasts_.data(), least, is_edge_.data(), stream_);
  cuda::Layers layers;
  layers.size = size;
  layers.volume = layers_.volume;
  layers.volume.pixels = edge_layer_.data();
  for (int ray = 0; ray < kEdgeRays && report.complete; ++ray) {
    CastLaunch of_ray = launch;
    of_ray.task.camera = edgeCamera(launch.task.camera, ray);
    of_ray.layer = layers.volume;
    of_ray.predicted = is_edge_.data();
    findBehind(scene, false, is_edge_.data(), seen_at_edges_, of_ray, layers);
    FrameReport counted;
    report.complete = castLattices(of_ray, sourceLattices(Pattern::full, size), stop, counted);
    if (report.complete) cuda::addEdgeRay(layers, is_edge_.data(), ray == 0, edge_means_.data(), stream_);
  }
  is_smooth_ = report.complete;
  report.rays += kEdgeRays * edges;
}

/// Called after the last launch: makes the picture and waits for it.
void CudaFrameCaster::finish(FrameReport& report) {
  beginTime();
  if (report.complete) showPicture8(layers_, picture8_.data(), stream_);
  if (report.complete && is_smooth_)
    cuda::putEdges(layers_.size, is_edge_.data(), edge_means_.data(), nullptr, picture8_.data(), stream_);
  end_.record(stream_);
  volume_->storage().endReading(stream_);
  stream_.wait();
  report.cast_ms = end_.since_ms(begin_);
}

/// @return false if it was stopped
bool CudaFrameCaster::castLattices(const CastLaunch& launch, const std::vector<Lattice>& lattices,
                                   const StopFlag* stop, FrameReport& report) {
  for (const Lattice& lattice : lattices) {
    const int rows = static_cast<int>(
        std::min<long long>(std::max<long long>(max_rays_ / lattice.columns, 1), lattice.rows));
    for (int row = 0; row < lattice.rows; row += rows) {
      if (isStopped(stop)) return false;
      Lattice band = lattice;
      band.first_y += row * lattice.step_y;
      band.rows = std::min(rows, lattice.rows - row);
      CastLaunch part = launch;
      part.tiles.lattice = band;
      beginTime();
      cast(part);
    }
    report.rays += lattice.count();
  }
  return true;
}

/// @return false if it was stopped
bool CudaFrameCaster::castAdaptive(const CastLaunch& launch, const FramePlan& plan, const StopFlag* stop) {
  predicted_.resize(picture8_.size());
  missing_rays_ = silhouette_.count();
  if (rays_.size() == 0) {
    rays_.resize(1);
    check(cudaMemsetAsync(rays_.data(), 0, sizeof(unsigned), stream_), "cudaMemset");
  }
  tolerance_levels_ = hold_.levels(plan.tolerance_levels);
  if (isStopped(stop)) {
    check(cudaMemsetAsync(predicted_.data(), true, predicted_.size(), stream_), "cudaMemset");
    return false;
  }
  cuda::AdaptiveLaunch adaptive{launch};
  adaptive.inside = inside_.data();
  adaptive.tolerance_levels = static_cast<float>(tolerance_levels_);
  adaptive.is_predicted = predicted_.data();
  adaptive.rays = rays_.data();
  beginTime();
  cuda::castAdaptive(adaptive, mode_, sampling_, stream_);
  return true;
}

/// Counts the rays of the frame, for its report and for the tolerance of the next one.
void CudaFrameCaster::countAdaptive(const FramePlan& plan, FrameReport& report) {
  unsigned rays = 0;
  rays_.download(&rays, stream_);
  report.rays = rays - std::exchange(rays_before_, rays);
  missing_rays_ -= report.rays;
  const double max_rays = std::max(plan.ray_share * static_cast<double>(silhouette_.count()), 1.0);
  hold_.drawn(tolerance_levels_, static_cast<double>(report.rays), max_rays);
}

void CudaFrameCaster::fetch(Image& image) {
  if (image.size != layers_.size) image = Image(layers_.size);
  if (image.pixels.empty()) return;
  picture_.resize(picture8_.size());
  showPicture(layers_, picture_.data(), stream_);
  if (is_smooth_)
    cuda::putEdges(layers_.size, is_edge_.data(), edge_means_.data(), picture_.data(), nullptr, stream_);
  static_assert(sizeof(Rgba) == sizeof(float4), "a pixel is four floats");
  picture_.download(reinterpret_cast<float4*>(image.pixels.data()), stream_);
}

void CudaFrameCaster::fetch(Image8& image) {
  image.size = layers_.size;
  image.rgba.resize(4 * static_cast<std::size_t>(image.size.count()));
  static_assert(sizeof(uchar4) == 4, "a pixel is four bytes");
  if (!image.rgba.empty()) picture8_.download(reinterpret_cast<uchar4*>(image.rgba.data()), stream_);
}

std::shared_ptr<const DevicePicture> CudaFrameCaster::compose(const OverlayLayers& layers) {
  const ImageSize size = layers_.size;
  if (layers.size != size) throw Error(ErrorCode::other, "labels and picture differ in size");
  const auto is_other_size = [&](const auto& picture) { return picture->size() != size; };
  finished_.erase(std::remove_if(finished_.begin(), finished_.end(), is_other_size), finished_.end());
  const auto unused = std::find_if(finished_.begin(), finished_.end(),
                                   [](const auto& picture) { return picture.use_count() == 1; });
  auto picture = unused != finished_.end() ? *unused : std::make_shared<cuda::PictureMemory>(size);
  if (unused == finished_.end()) finished_.push_back(picture);
  behind_.upload(layers.behind, stream_);
  front_.upload(layers.front, stream_);
  cuda::composeOverlay(static_cast<unsigned>(size.count()), behind_.data(), picture8_.data(), front_.data(),
                       picture->pixels(), stream_);
  stream_.wait();
  return picture;
}

}  // namespace

std::unique_ptr<FrameCaster> makeCudaCaster(volume::VoxelPrecision precision) {
  const Device device = findDevice();
  if (!device.usable) {
    throw Error(ErrorCode::device, "pictures cast by the GPU: " + device.why_not);
  }
  return std::make_unique<CudaFrameCaster>(precision);
}

}  // namespace emscape::render
