#include <utility>

#include "propagation/cuda/march_cuda.h"
#include "propagation/parabolic_equation/excess.h"
#include "propagation/parabolic_equation/march/march_block_run.h"
#include "propagation/parabolic_equation/march/march_block_tables.h"

namespace emscape::propagation {
namespace {

using cuda::check;
using cuda::checkLaunch;

constexpr int kTableThreads = 128;

/// The threads of a block, each with its own registers.
template <class Shape>
struct BlockTeam {
  BlockThread& own;

  template <class Function>
  __device__ void each(const Function& f) {
    f(int(threadIdx.x), own);
    __syncthreads();
  }
  template <class Function>
  __device__ void eachInRows(const Function& f) {
    f(int(threadIdx.x), own);
    if (Shape::kLanes > 32) {
      __syncthreads();
    } else {
      __syncwarp();
    }
  }
  template <class Function>
  __device__ void eachFree(const Function& f) {
    f(int(threadIdx.x), own);
  }
};

/// Blocks per multiprocessor: 360 azimuths on 132 multiprocessors need three.
template <class Shape>
constexpr int kBlocks = Shape::kIntervals <= 2048   ? 3
                        : Shape::kIntervals <= 4096 ? 2
                                                    : 1;

template <class Shape, BlockKind kKind>
__global__ void __launch_bounds__(Shape::kThreads, kBlocks<Shape>)
    marchKernel(const __grid_constant__ MarchBlockTask task) {
  extern __shared__ __align__(16) char shared[];
  BlockMemory memory;
  memory.place<Shape>(shared, task);
  BlockThread own;
  BlockTeam<Shape> team{own};
  BlockTransform<Shape, BlockTeam<Shape>>::prepare(team, memory);
  BlockMarch<Shape, kKind, BlockTeam<Shape>>(task, int(blockIdx.x), team, memory).run();
}

__global__ void tablesKernel(const __grid_constant__ MarchBlockTask task,
                             const __grid_constant__ BlockTables tables, int intervals) {
  fillTables(task, tables, intervals, int(blockIdx.x * blockDim.x + threadIdx.x));
}

__global__ void planKernel(const __grid_constant__ MarchBlockTask task, int intervals, PlannedStep* planned) {
  const int azimuth = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (azimuth < task.azimuths) planSteps(task, intervals, planned, azimuth);
}

__global__ void copyStart(const StoredComplex* start, StoredComplex* fields, int count, std::size_t pitch) {
  const int j = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (j < count) fields[blockIdx.y * pitch + j] = start[j];
}

}  // namespace

template <class Shape>
void AzimuthMarchCuda::launch(MarchBlockTask task, cudaStream_t stream) {
  constexpr int N = Shape::kIntervals, kEntries = 16 * Shape::kSpectral;
  StoredComplex* next = tables_.data();
  const auto take = [&](int count) {
    StoredComplex* const taken = next;
    next += count;
    return taken;
  };
  BlockTables tables;
  if (input_.flat) {
    task.propagator = tables.propagator = take(kEntries);
  } else {
    task.exponents = tables.exponents = take(kEntries);
  }
  if (input_.flat && input_.steady_air) {
    task.half_screen = tables.half_screen = take(N + 1);
    task.whole_screen = tables.whole_screen = take(N + 1);
    task.half_in_runs = tables.half_in_runs = take(N);
    task.whole_in_runs = tables.whole_in_runs = take(N);
  }
  if (task.mixed) task.weights = tables.weights = take(N);
  tablesKernel<<<(kEntries + kTableThreads - 1) / kTableThreads, kTableThreads, 0, stream>>>(task, tables, N);
  checkLaunch("marchTables");
  if (!input_.flat) {
    constexpr int kRowsOfBlock = 32;
    planKernel<<<(task.azimuths + kRowsOfBlock - 1) / kRowsOfBlock, kRowsOfBlock, 0, stream>>>(
        task, N, planned_.data());
    checkLaunch("planSteps");
    task.planned = planned_.data();
  }
  BlockMemory memory;
  const std::size_t bytes = memory.place<Shape>(nullptr, task);
  withBlockKind(input_.kind, [&](auto kind) {
    const auto kernel = marchKernel<Shape, decltype(kind)::value>;
    check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, int(bytes)),
          "cudaFuncSetAttribute");
    kernel<<<unsigned(task.azimuths), Shape::kThreads, bytes, stream>>>(task);
  });
  checkLaunch("march");
}

void AzimuthMarchCuda::start(const AzimuthMarch& march, float* excess_db, cudaStream_t stream,
                             const std::vector<int>& columns_at) {
  start(march, blockInput(march, kMaxBlockIntervals, columns_at), excess_db, stream, columns_at);
}

void AzimuthMarchCuda::start(const AzimuthMarch& march, BlockInput input, float* excess_db,
                             cudaStream_t stream, const std::vector<int>& columns_at) {
  if (march.grid.form == PeForm::narrow && !march.ground_msl_m.empty()) {
    throw Error(ErrorCode::bad_input, "parabolic_equation: the narrow form over terrain is not for a GPU");
  }
  input_ = std::move(input);
  grid_ = march.grid;
  azimuths_ = march.azimuths;
  columns_at_ = columns_at;
  stream_ = stream;
  const std::size_t pitch = std::size_t(march.grid.intervals), azimuths = std::size_t(azimuths_);
  segments_.send(input_.segments, stream);
  levels_.send(input_.levels, stream);
  first_segment_.send(input_.first_segment, stream);
  cell_end_.send(input_.cell_end, stream);
  ground_.send(march.ground_msl_m, stream);
  start_.send(input_.start, stream);
  states_.send(input_.states, stream);
  column_steps_.send(columns_at_, stream);
  const std::size_t cells = azimuths * std::size_t(input_.tasks.front().sumsOfCells());
  const std::size_t columns = azimuths * columns_at.size();
  fields_.atLeast(azimuths * pitch);
  tables_.atLeast(16 * 9 * (pitch / 128 + 1) + 5 * pitch + 8);
  sums_.atLeast(cells);
  counts_.atLeast(cells);
  if (!input_.flat) planned_.atLeast(azimuths * std::size_t(input_.tasks.front().end_step));
  amplitudes_.atLeast(columns * pitch);
  column_intervals_.atLeast(columns);
  column_ground_.atLeast(columns);
  if (cells > 0) {
    check(cudaMemsetAsync(sums_.data(), 0, cells * sizeof(float), stream), "cudaMemsetAsync");
    check(cudaMemsetAsync(counts_.data(), 0, cells * sizeof(int), stream), "cudaMemsetAsync");
  }
  const auto count = unsigned(pitch);
  copyStart<<<dim3((count + kTableThreads - 1) / kTableThreads, unsigned(azimuths)), kTableThreads, 0,
              stream>>>(start_.data(), fields_.data(), int(count), pitch);
  checkLaunch("copyStart");
  for (std::size_t i = 0; i < input_.tasks.size(); ++i) {
    MarchBlockTask task = input_.tasks[i];
    task.ground_msl_m = input_.flat ? nullptr : ground_.data();
    task.segments = segments_.data();
    task.levels = levels_.data();
    task.first_segment = first_segment_.data();
    task.cell_end = cell_end_.data();
    task.excess_db = excess_db;
    task.columns = int(columns_at.size());
    task.column_steps = column_steps_.data();
    task.amplitudes = amplitudes_.data();
    task.column_intervals = column_intervals_.data();
    task.column_ground_m = column_ground_.data();
    task.states = states_.data();
    task.pitch = pitch;
    task.fields = fields_.data();
    task.sums = sums_.data();
    task.counts = counts_.data();
    withBlockShape<kMaxBlockIntervals>(input_.intervals[i],
                                       [&](auto shape) { launch<decltype(shape)>(task, stream); });
  }
}

std::size_t AzimuthMarchCuda::bytes() const {
  const auto bytesOf = [](const auto&... buffers) {
    return (std::size_t(0) + ... + (buffers.size() * sizeof(*buffers.data())));
  };
  return bytesOf(segments_, levels_, first_segment_, cell_end_, counts_, column_steps_, column_intervals_,
                 ground_, sums_, amplitudes_, column_ground_, start_, fields_, tables_, states_, planned_);
}

std::vector<FieldColumn> AzimuthMarchCuda::columns() {
  const std::size_t count = std::size_t(azimuths_) * columns_at_.size(), pitch = std::size_t(grid_.intervals);
  std::vector<int> intervals(count);
  std::vector<double> ground_m(count);
  std::vector<float> amplitudes(count * pitch);
  column_intervals_.download(intervals.data(), count, stream_);
  column_ground_.download(ground_m.data(), count, stream_);
  amplitudes_.download(amplitudes.data(), count * pitch, stream_);
  std::vector<FieldColumn> columns(count);
  for (std::size_t i = 0; i < count; ++i) {
    columns[i].range_m = columns_at_[i % columns_at_.size()] * grid_.range_step_m;
    columns[i].ground_msl_m = ground_m[i];
    columns[i].height_step_m = grid_.top_m / intervals[i];
    const auto first = amplitudes.begin() + std::ptrdiff_t(i * pitch);
    columns[i].amplitude.assign(first, first + intervals[i]);
  }
  return columns;
}

void marchAzimuthsOnGpu(const AzimuthMarch& march, float* excess_db) {
  AzimuthMarchCuda cuda_march;
  cuda::Stream stream;
  cuda::Buffer<float> plane(march.cellCount());
  cuda_march.start(march, plane.data(), stream);
  plane.download(excess_db, stream);
}

std::vector<FieldColumn> columnsOnGpu(const AzimuthMarch& march, const std::vector<int>& steps) {
  AzimuthMarchCuda cuda_march;
  cuda::Stream stream;
  cuda::Buffer<float> plane(march.cellCount());
  cuda_march.start(march, plane.data(), stream, steps);
  return cuda_march.columns();
}

}  // namespace emscape::propagation
