#include <algorithm>
#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_tiles.h"
#include "emfield/cuda/itm_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;
using propagation::ColumnPart;
using propagation::kBisectionStep;

unsigned blocksFor(int threads) {
  return static_cast<unsigned>((threads + kColumnThreads - 1) / kColumnThreads);
}

/// Memory of the columns in progress.
class ColumnMemory {
 public:
  /// State of a column between two kernels.
  struct Begun {
    ExcessColumn column;
    bool is_open;  ///< there are voxels to fill
  };

  ColumnMemory(const ScratchMemory& memory, int posts, int layers)
      : memory_(static_cast<char*>(memory.data)), posts_(posts), layers_(layers) {
    constexpr std::size_t kAlignment = alignof(Begun);
    bytes_each_ =
        (sizeof(Begun) + ExcessScratch::bytes(posts, layers) + kAlignment - 1) / kAlignment * kAlignment;
    columns_ = static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each_, 1 << 30)) / kColumnThreads *
               kColumnThreads;
    if (columns_ == 0) throwTooSmall(bytes_each_, memory.bytes);
  }
  int columns() const { return columns_; }
  __device__ Begun& begun(int n) const { return *reinterpret_cast<Begun*>(memory_ + n * bytes_each_); }
  __device__ ExcessScratch scratch(int n) const {
    return ExcessScratch::in(memory_ + n * bytes_each_ + sizeof(Begun), posts_, layers_);
  }

 private:
  char* memory_;
  std::size_t bytes_each_;
  int columns_;
  int posts_, layers_;
};

/// Whole columns, one per thread.
template <class Model>
__global__ void __launch_bounds__(kColumnThreads)
    excessKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
                 const __grid_constant__ ColumnMemory memory) {
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int threads = static_cast<int>(gridDim.x * blockDim.x);
  const ExcessGrid& grid = task.grid;
  const ExcessScratch scratch = memory.scratch(thread);
  for (std::size_t c = thread; c < grid.column_count; c += threads) {
    if (grid.isLeftOut(c)) {
      for (int k = 0; k < grid.layers; ++k) to.out.excess.set(k * grid.column_count + c, 0);
      continue;
    }
    const unsigned warnings = task.fillColumn(c, scratch, PostReader{}, to.out.reflected, to.out.mechanisms);
    note(to, static_cast<int>(c), warnings);
    for (int k = 0; k < grid.layers; ++k) {
      to.out.excess.set(k * grid.column_count + c, scratch.excess_db[k]);
    }
  }
}

/// A segment of some columns.
struct ColumnRun {
  int first, count;
  int segment;
};

/// The part that runs once per column.
template <class Model>
__global__ void __launch_bounds__(kColumnThreads)
    beginKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
                const __grid_constant__ ColumnMemory memory, ColumnRun run) {
  const int n = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (n >= run.count) return;
  if (task.grid.isLeftOut(run.first + n)) {
    memory.begun(n).is_open = false;
    for (int k = 0; k < task.grid.layers; ++k)
      to.out.excess.set(k * task.grid.column_count + run.first + n, 0);
    return;
  }
  const ExcessScratch scratch = memory.scratch(n);
  const ExcessColumn column = task.readSegment(run.first + n, run.segment, scratch, PostReader{});
  const int first = task.grid.firstLayer(run.segment);
  const unsigned warnings = task.model.begin(column, scratch, scratch.excess_db + first);
  memory.begun(n) = {column, warnings == 0};
  if (warnings == 0) return;
  note(to, run.first + n, warnings);
  for (int k = 0; k < column.count; ++k) {
    const float excess_db = scratch.excess_db[first + k];
    to.out.excess.set((first + k) * task.grid.column_count + run.first + n, excess_db);
  }
}

/// Parts of columns, one per thread: neighbours read the same profile.
template <class Model>
__global__ void __launch_bounds__(kColumnThreads)
    fillKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
               const __grid_constant__ ColumnMemory memory, ColumnRun run, int parts) {
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int n = thread / parts;
  if (n >= run.count) return;
  const ColumnMemory::Begun begun = memory.begun(n);
  const int begin = thread % parts * kBisectionStep;
  const int end = min(begin + kBisectionStep, begun.column.count);
  if (!begun.is_open || begin >= end) return;
  const ExcessScratch scratch = memory.scratch(n);
  const int first = task.grid.firstLayer(run.segment);
  const auto c = static_cast<std::size_t>(run.first + n);
  const auto voxel = [&](int k) { return (first + k) * task.grid.column_count + c; };
  float* const excess_db = scratch.excess_db + first;
  float memory_db[kBisectionStep + 1];
  const ColumnPart part{begin, end, memory_db};
  const unsigned warnings = task.model.fill(begun.column, scratch, part, excess_db);
  note(to, run.first + n, warnings);
  task.addEnds(c, run.segment, begun.column, begin, end, excess_db);
  for (int k = begin; k < end; ++k) to.out.excess.set(voxel(k), excess_db[k]);
}

/// Models with kernels of their own.
template <class Model>
constexpr bool hasOwnKernel =
    std::is_same_v<Model, propagation::PeExcess> || std::is_same_v<Model, DiffractionExcess>;
template <class Model>
constexpr bool isItm = std::is_same_v<Model, propagation::ItmExcess>;

template <class Model>
void launchExcess(const ExcessTask<Model>& task, const ExcessOutputs& to, const ColumnMemory& memory,
                  cudaStream_t stream) {
  const ExcessGrid& grid = task.grid;
  const int columns = static_cast<int>(grid.column_count);
  if constexpr (!Model::kInParts) {
    excessKernel<<<blocksFor(std::min(memory.columns(), columns)), kColumnThreads, 0, stream>>>(task, to,
                                                                                                memory);
    checkLaunch("excess");
  } else {
    const int parts = (grid.firstLayer(1) + kBisectionStep) / kBisectionStep;  // segments differ by one layer
    const int runs = (columns + memory.columns() - 1) / memory.columns();
    for (int segment = 0; segment < grid.segments; ++segment) {
      for (int r = 0; r < runs; ++r) {
        const int first = static_cast<int>(static_cast<long long>(columns) * r / runs);
        const int end = static_cast<int>(static_cast<long long>(columns) * (r + 1) / runs);
        const ColumnRun run{first, end - first, segment};
        beginKernel<<<blocksFor(run.count), kColumnThreads, 0, stream>>>(task, to, memory, run);
        checkLaunch("excess of columns");
        fillKernel<<<blocksFor(run.count * parts), kColumnThreads, 0, stream>>>(task, to, memory, run, parts);
        checkLaunch("excess of parts");
      }
    }
  }
}

}  // namespace

void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const GroundPosts& ground, const ExcessOutputs& to, const ScratchMemory& scratch,
                cudaStream_t stream) {
  std::visit(
      [&](const auto& m) {
        using Model = std::decay_t<decltype(m)>;
        if constexpr (!hasOwnKernel<Model>) {
          ExcessTask<Model> task{m, excess.air, station, grid, ground, excess.terminal};
          task.ground.is_raised = excess.is_raised && ground.terrain.hasCover();
          task.ground.has_clutter = excess.has_clutter;
          if constexpr (isItm<Model>) {
            fillItm(task, to, scratch, stream);
          } else {
            launchExcess(task, to, ColumnMemory(scratch, task.posts(), grid.layers), stream);
          }
        }
      },
      excess.model);
}

}  // namespace emscape::emfield::cuda
