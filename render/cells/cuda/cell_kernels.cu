#include "base/cuda/cuda_memory.h"
#include "render/cells/cell_caster.h"
#include "render/cells/cuda/tile_projector.h"

namespace emscape::render {
namespace {

constexpr int kTile = FaceTiles::kTile;

/// Faces through which rays of a tile may enter.
struct TilesView {
  const volume::FaceId* faces;  ///< of all tiles, one after another
  const int* first;             ///< first face of each tile; one more at the end
  int columns;
};

struct CastTask {
  CellMeshView mesh;
  IntervalsView transfer;
  PsiLookup psi;
  CameraView camera;
  TilesView tiles;
  int start_cell;
  double through;
  const double* end_distance;  ///< null: no ray ends
};

/// The nearest entries of a ray behind one of them.
class NextEntries {
 public:
  static constexpr int kMost = 6;

  __device__ NextEntries(const CastTask& task, const RayFrame& frame, int tile, const EntryHit& after) {
    for (int n = task.tiles.first[tile]; n < task.tiles.first[tile + 1]; ++n) {
      EntryHit hit;
      if (entersThrough(task.mesh, frame, task.tiles.faces[n], hit) &&
          (task.camera.orthographic || hit.distance >= 0) && after < hit) {
        insert(hit);
      }
    }
  }
  /// Entries behind these may be missing.
  __device__ bool isFull() const { return count_ == kMost; }
  __device__ int count() const { return count_; }
  __device__ const EntryHit& operator[](int n) const { return hits_[n]; }

  __device__ void insert(const EntryHit& hit) {
    if (count_ == kMost && !(hit < hits_[kMost - 1])) return;
    int place = count_ < kMost ? count_++ : kMost - 1;
    for (; place > 0 && hit < hits_[place - 1]; --place) hits_[place] = hits_[place - 1];
    hits_[place] = hit;
  }

 private:
  EntryHit hits_[kMost];
  int count_ = 0;
};

__global__ void __launch_bounds__(kTile* kTile)
    castCells(const __grid_constant__ CastTask task, Rgba* picture, CellCounts* counts) {
  const int tile = static_cast<int>(blockIdx.x);
  const int x = tile % task.tiles.columns * kTile + static_cast<int>(threadIdx.x % kTile);
  const int y = tile / task.tiles.columns * kTile + static_cast<int>(threadIdx.x / kTile);
  const ImageSize size = task.camera.size;
  const bool is_inside = x < size.width && y < size.height;
  long long cells = 0;
  bool is_hit = false;
  if (is_inside) {
    const int pixel = y * size.width + x;
    const RayFrame frame(task.camera.ray(x, y));
    const MarchLimits limits{task.end_distance != nullptr ? task.end_distance[pixel] : HUGE_VAL,
                             task.through};
    RayIntegral integral(task.transfer, task.psi);
    EntryHit last{-HUGE_VAL, volume::kNoFace};
    double been = -HUGE_VAL;
    if (task.start_cell >= 0) {  // the eye is in the mesh: the line enters this cell behind it
      EntryHit start{0, entryFaceOf(task.mesh, frame, task.start_cell)};
      entersThrough(task.mesh, frame, start.face, start);
      start.distance = fmin(start.distance, 0.0);
      been = march(task.mesh, frame, start, been, limits, integral, cells);
      is_hit = true;
    }
    for (bool is_done = false; !is_done;) {
      const NextEntries entries(task, frame, tile, last);
      is_hit = is_hit || entries.count() > 0;
      is_done = !entries.isFull();
      for (int n = 0; n < entries.count(); ++n) {
        last = entries[n];
        if (last.distance >= limits.distance || integral.through() < limits.through) {
          is_done = true;
          break;
        }
        been = march(task.mesh, frame, last, been, limits, integral, cells);
      }
    }
    picture[pixel] = integral.color();
  }
  const int rays = __syncthreads_count(is_hit);
  for (int lane = 16; lane > 0; lane /= 2) cells += __shfl_down_sync(0xffffffffu, cells, lane);
  if (threadIdx.x % 32 == 0) atomicAdd(&counts->cells, static_cast<unsigned long long>(cells));
  if (threadIdx.x == 0) atomicAdd(&counts->rays, static_cast<unsigned long long>(rays));
}

class CudaCellCaster : public CellCaster {
 public:
  CudaCellCaster() {
    psi_.upload(PsiTable::shared().lookup().values, PsiLookup::kEntries * PsiLookup::kEntries);
  }

  void setMesh(const CellMesh& mesh, bool points_too) override {
    if (points_too) {
      const CellMeshView view = mesh.view();
      points_.upload(mesh.points);
      vertices_.upload(view.vertices, 4 * mesh.mesh->cells.size());
      other_side_.upload(mesh.faces->other_side);
    }
    values_.upload(mesh.values);
  }

  void setTransfer(const LinearTransfer& transfer) override { intervals_.upload(transfer.intervals()); }

  TileTimes project(const TileCast& cast, Image& image) override {
    end_distance_.upload(cast.end_depth, stream_);
    TileTask task = cast.task;
    task.transfer = transferView();
    task.psi = {cast.table ? psi_.data() : nullptr};
    task.end_depth = end_distance_.data();
    const MeshOnDevice mesh{meshView(), static_cast<int>(points_.size()),
                            static_cast<int>(vertices_.size() / 4)};
    return projector_.project(task, mesh, cast.sorting, image, stream_);
  }

  CellCounts cast(const CellCast& cast, const FaceTiles& tiles, Image& image) override {
    const FaceTiles::Lists lists = tiles.lists();
    faces_.upload(lists.faces, stream_);
    first_.upload(lists.first, stream_);
    end_distance_.upload(cast.end_distance, stream_);
    counts_.upload(std::vector<CellCounts>(1), stream_);
    picture_.resize(static_cast<std::size_t>(cast.camera.size.count()));
    CastTask task;
    task.mesh = meshView();
    task.transfer = transferView();
    task.psi = {cast.table ? psi_.data() : nullptr};
    task.camera = cast.camera;
    task.tiles = {faces_.data(), first_.data(), (cast.camera.size.width + kTile - 1) / kTile};
    task.start_cell = cast.start_cell;
    task.through = cast.through;
    task.end_distance = end_distance_.data();
    castCells<<<static_cast<unsigned>(tiles.count()), kTile * kTile, 0, stream_>>>(task, picture_.data(),
                                                                                   counts_.data());
    emscape::cuda::checkLaunch("castCells");
    image = Image(cast.camera.size);
    picture_.download(image.pixels.data(), stream_);
    CellCounts counts;
    counts_.download(&counts, stream_);
    return counts;
  }

 private:
  CellMeshView meshView() const {
    return {points_.data(), vertices_.data(), other_side_.data(), values_.data()};
  }
  IntervalsView transferView() const { return {intervals_.data(), static_cast<int>(intervals_.size())}; }

  emscape::cuda::Stream stream_;
  TileProjector projector_;
  emscape::cuda::Buffer<Vec3d> points_;
  emscape::cuda::Buffer<std::int32_t> vertices_;
  emscape::cuda::Buffer<volume::FaceId> other_side_;
  emscape::cuda::Buffer<float> values_, psi_;
  emscape::cuda::Buffer<double> end_distance_;
  emscape::cuda::Buffer<TransferInterval> intervals_;
  emscape::cuda::Buffer<volume::FaceId> faces_;
  emscape::cuda::Buffer<int> first_;
  emscape::cuda::Buffer<Rgba> picture_;
  emscape::cuda::Buffer<CellCounts> counts_;
};

}  // namespace

std::unique_ptr<CellCaster> makeCudaCellCaster() {
  return std::make_unique<CudaCellCaster>();
}

}  // namespace emscape::render
