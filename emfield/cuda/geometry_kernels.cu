#include "base/cuda/cuda_memory.h"
#include "emfield/columns/column_geometry.h"
#include "emfield/cuda/column_tiles.h"
#include "emfield/cuda/geometry_kernels.h"
#include "emfield/geometry/clutter_map.h"
#include "emfield/solver/field_engine.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;

constexpr int kThreads = 128;

unsigned blocksFor(int threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

__global__ void locateKernel(const LocateTask* tasks, DeviceColumns columns) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c >= columns.count) return;
  const LocateTask& task = tasks[blockIdx.y];
  const GridColumn column = columns.columns[c];
  columnGeometry(task.station, column, footInverse(task.station, column, columns.middle_m), columns.middle_m,
                 task.numbers + c, columns.count);
  task.shadow_edge_m[c] = -HUGE_VALF;

  const ColumnGeometryView numbers = columnGeometryView(task.numbers, static_cast<std::size_t>(columns.count),
                                                        task.shadow_edge_m, {}, nullptr, nullptr);
  const int near = nearVoxels(numbers, c, columns.t_m, columns.layers, task.near2_m2);
  if (near > 0) atomicAdd(&task.counts->near_voxels, static_cast<unsigned long long>(near));
}

__global__ void termsKernel(const DeviceShadowTask* tasks) {
  const DeviceShadowTask& shadow = tasks[blockIdx.y];
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= shadow.task.ground.range_count) return;
  shadow.terms[i] = shadow.task.geometry().termsAt(shadow.task.ground.ranges_m[i]);
}

/// One thread per column.
__global__ void __launch_bounds__(kColumnThreads)
    edgesKernel(const DeviceShadowTask* tasks, const __grid_constant__ ExcessGrid grid,
                const __grid_constant__ Tiles tiles) {
  tiles.eachColumn([&](int number, int column, int) {
    const auto c = static_cast<std::size_t>(column);
    if (grid.isLeftOut(c)) return;
    const DeviceShadowTask& shadow = tasks[number];
    const ShadowTask& task = shadow.task;
    const HorizonGeometry<float> geometry = task.geometry();
    const auto slopeTo = [&](const FastInverse& path, int count) {
      propagation::GrazingSlope<float> slope;
      const auto add = [&](int i, float height_msl_m) {
        slope.add(height_msl_m, geometry.slopeTo(height_msl_m, shadow.terms[i]));
      };
      const auto isHidden = [&](int first, int last, float highest_msl_m) {
        return task.slopeBound(first, last, highest_msl_m) <= slope.highest;
      };
      visitPosts(task.station, task.ground, path, count, add, task.firstPost(grid, c, path, count), isHidden);
      return slope.value();
    };
    const float edge_m = task.edge_m(grid, c, slopeTo);
    shadow.shadow_edge_m[c] = edge_m;
    if (isnan(edge_m)) atomicAdd(&shadow.counts->unknown_columns, 1);
  });
}

__global__ void unknownKernel(const float* shadow_edge_m, int columns, std::uint8_t* unknown) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (c < columns) unknown[c] = isnan(shadow_edge_m[c]) ? 1 : 0;
}

/// One thread per azimuth.
__global__ void clutterKernel(const __grid_constant__ ClutterMapTask task, ClutterCell* cells) {
  const int azimuth = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (azimuth < task.grid.azimuths)
    task(azimuth, cells + static_cast<std::size_t>(azimuth) * task.grid.ranges);
}

/// One thread per range.
__global__ void weighKernel(const __grid_constant__ ClutterMapTask task, ClutterCell* cells) {
  const int range = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (range < task.grid.ranges) task.weighBeside(range, cells);
}

}  // namespace

void fillClutterMap(const ClutterMapTask& task, ClutterCell* cells, cudaStream_t stream) {
  constexpr int kOfBlock = 32;  // few, to use as many multiprocessors as possible
  const auto blocks = [](int count) { return static_cast<unsigned>((count + kOfBlock - 1) / kOfBlock); };
  clutterKernel<<<blocks(task.grid.azimuths), kOfBlock, 0, stream>>>(task, cells);
  weighKernel<<<blocks(task.grid.ranges), kOfBlock, 0, stream>>>(task, cells);
  checkLaunch("clutterMap");
}

void markUnknownColumns(const float* shadow_edge_m, int columns, std::uint8_t* unknown, cudaStream_t stream) {
  unknownKernel<<<blocksFor(columns), kThreads, 0, stream>>>(shadow_edge_m, columns, unknown);
  checkLaunch("unknownColumns");
}

void locateColumns(const LocateTask* tasks, int count, const DeviceColumns& columns, cudaStream_t stream) {
  const dim3 blocks(blocksFor(columns.count), static_cast<unsigned>(count));
  locateKernel<<<blocks, kThreads, 0, stream>>>(tasks, columns);
  checkLaunch("locateColumns");
}

void findShadowEdges(const DeviceShadowTask* tasks, int count, int ranges, const ExcessGrid& grid, int row,
                     cudaStream_t stream) {
  const auto emitters = static_cast<unsigned>(count);
  termsKernel<<<dim3(blocksFor(ranges), emitters), kThreads, 0, stream>>>(tasks);
  checkLaunch("rangeTerms");
  const Tiles tiles(grid, row, count);
  edgesKernel<<<static_cast<unsigned>(tiles.count()), kColumnThreads, 0, stream>>>(tasks, grid, tiles);
  checkLaunch("shadowEdges");
}

}  // namespace emscape::emfield::cuda
