#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_tiles.h"

namespace emscape::emfield::cuda {
namespace {

using propagation::PeLoss;
using propagation::PeSight;
using propagation::PeSightWalk;
using propagation::SightPosts;

/// Memory for the posts of the columns in progress: for each post, the values of consecutive threads.
class SightMemory {
 public:
  /// @param posts  before the farthest column
  SightMemory(const ScratchMemory& memory, int posts) : posts_(posts) {
    const std::size_t bytes_each = 2 * sizeof(float) * static_cast<std::size_t>(posts);
    threads_ = static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each, 1 << 30)) / kColumnThreads *
               kColumnThreads;
    if (threads_ == 0) throwTooSmall(bytes_each, memory.bytes);
    numbers_ = static_cast<float*>(memory.data);
  }
  int threads() const { return threads_; }
  __device__ SightPosts of(int thread) const {
    return {numbers_ + thread, numbers_ + static_cast<std::size_t>(posts_) * threads_ + thread,
            static_cast<std::size_t>(threads_)};
  }

 private:
  float* numbers_;
  int posts_, threads_;
};

/// The ground before a column, as between the posts of its profile.
__device__ float groundBefore(const EquationTask& task, const FastInverse& path, float end_msl_m,
                              float range_m) {
  const int post = task.ground.lastBefore(range_m);
  const auto heightAt = [&](double at_m) {
    return groundAt(task.station, task.ground, {at_m, path.sin_azimuth, path.cos_azimuth});
  };
  const double post_m = task.ground.ranges_m[post];
  const bool is_last = post >= task.ground.lastBefore(path.distance_m);
  const double next_m = is_last ? path.distance_m : task.ground.ranges_m[post + 1];
  return propagation::PeExcess::groundBetween(post_m, heightAt(post_m), next_m,
                                              is_last ? end_msl_m : heightAt(next_m), range_m);
}

/// A segment of a column.
__device__ void fillSegment(const EquationTask& task, const ExcessGrid& grid, int c, int segment,
                            const SightPosts& posts) {
  const propagation::PeExcess& model = task.model;
  const GridColumn base = grid.columns[static_cast<std::size_t>(c)];
  const FastInverse path = grid.coordinatesOf(task.station, static_cast<std::size_t>(c), segment);
  propagation::ExcessColumn column;
  column.range_m = path.distance_m;
  column.azimuth_rad = std::atan2(path.sin_azimuth, path.cos_azimuth);
  column.ground_msl_m =
      grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(task.station, task.ground, path);
  PeSightWalk walk = model.others.sightWalk(path.distance_m, posts);
  visitPosts(task.station, task.ground, path, task.ground.lastBefore(path.distance_m) + 1,
             [&](int i, float height_msl_m) {
               walk.add({static_cast<float>(task.ground.ranges_m[i]), height_msl_m});
             });
  const PeSight sight = walk.sight(column.ground_msl_m);
  const auto beside = model.azimuthsAt(column.azimuth_rad);
  const auto ground_msl_m = [&](float range_m) {
    return groundBefore(task, path, column.ground_msl_m, range_m);
  };
  const propagation::AirColumn above(task.air, static_cast<float>(path.distance_m));
  for (int k = grid.firstLayer(segment); k < grid.firstLayer(segment + 1); ++k) {
    const std::size_t voxel = static_cast<std::size_t>(k) * grid.column_count + static_cast<std::size_t>(c);
    if (!sight.isKnown()) {
      task.to.out.excess.set(voxel, NAN);
      continue;
    }
    const auto height_msl_m = static_cast<float>(heightMsl_m(base, static_cast<double>(grid.t_m[k])));
    const PeLoss loss = model.lossAt(column, beside, sight, height_msl_m, ground_msl_m, [&] {
      return model.others.over_terrain ? task.to.out.excess.get(voxel)
                                       : model.others.twoRays_db(column.range_m, height_msl_m);
    });
    if (task.to.out.mechanisms != nullptr)
      task.to.out.mechanisms[voxel] = static_cast<std::uint8_t>(loss.mechanism(model.others.over_terrain));
    float excess_db = loss.loss_db();
    if (!task.air.isClear()) excess_db += above.lossDb(height_msl_m);
    task.to.out.excess.set(voxel, excess_db);
  }
  note(task.to, c, sight.isKnown() ? model.warnings : propagation::kMissingTerrain);
}

__global__ void __launch_bounds__(kColumnThreads)
    equationKernel(const __grid_constant__ EquationTask task, const __grid_constant__ ExcessGrid grid,
                   const __grid_constant__ SightMemory memory, const __grid_constant__ Tiles tiles) {
  tiles.eachColumn([&](int, int c, int thread) {
    if (grid.isLeftOut(static_cast<std::size_t>(c))) {
      for (int k = 0; k < grid.layers; ++k) task.to.out.excess.set(k * grid.column_count + c, 0);
      return;
    }
    for (int segment = 0; segment < grid.segments; ++segment)
      fillSegment(task, grid, c, segment, memory.of(thread));
  });
}

}  // namespace

void fillEquation(const EquationTask& task, const ExcessGrid& grid, int row, const ScratchMemory& scratch,
                  cudaStream_t stream) {
  const Tiles tiles(grid, row, 1);
  const SightMemory memory(scratch, task.ground.range_count);
  const int blocks = std::min(tiles.count(), memory.threads() / kColumnThreads);
  equationKernel<<<static_cast<unsigned>(blocks), kColumnThreads, 0, stream>>>(task, grid, memory, tiles);
  emscape::cuda::checkLaunch("equation");
}

}  // namespace emscape::emfield::cuda
