// `diffraction` on the device: a thread a column. See emfield/excess/column_diffraction.h.

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_tiles.h"
#include "emfield/cuda/diffraction_kernels.h"

namespace emscape::emfield::cuda {
namespace {

// Fewer registers, for more threads at a time, take more time.
template <int kReceivers>
__global__ void __launch_bounds__(kColumnThreads, 4)
    diffractionKernel(const DeviceDiffractionTask* tasks, const __grid_constant__ ExcessGrid grid,
                      const __grid_constant__ Tiles tiles) {
  tiles.eachColumn([&](int number, int c, int) {
    const DiffractionTask& task = tasks[number].task;
    const ExcessOutputs to{task.out, tasks[number].counts};
    const auto column = static_cast<std::size_t>(c);
    const bool is_unknown = grid.isWithoutGround(column);
    const int lowest = grid.firstValid(column);
    for (int k = 0; k < (is_unknown ? grid.layers : lowest); ++k)
      task.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + column, k < lowest ? 0 : NAN);
    if (is_unknown) return markUnknown(to, c);
    for (int segment = 0; segment < grid.segments; ++segment) {
      if (!emfield::fillDiffraction<kReceivers>(task, grid, c, segment)) markUnknown(to, c);
    }
  });
}

}  // namespace

void fillDiffraction(const DeviceDiffractionTask* tasks, int count, const ExcessGrid& grid, int row,
                     cudaStream_t stream) {
  const Tiles tiles(grid, row, count);
  const auto launch = [&](auto kernel) {
    kernel<<<static_cast<unsigned>(tiles.count()), kColumnThreads, 0, stream>>>(tasks, grid, tiles);
  };
  if (grid.layers == 1) {
    launch(diffractionKernel<1>);
  } else {
    launch(diffractionKernel<8>);
  }
  emscape::cuda::checkLaunch("diffraction");
}

}  // namespace emscape::emfield::cuda
