/// The orders in which a caster's launches take their tasks, kept from frame to frame.
#pragma once

#include <array>
#include <map>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"

namespace emscape::render::cuda {

class KeptOrders {
 public:
  /// Gives a launch of a lattice the order that the last one of such pixels found, and a place for the next.
  /// @param stream  of the launch
  void lend(CastLaunch& launch, cudaStream_t stream) {
    const Lattice& lattice = launch.pixels.lattice;
    Kept& kept = kept_[{lattice.first_x, lattice.first_y, lattice.step_x, lattice.step_y}];
    if (kept.orders.size() == 0) {
      kept.orders.resize(2);
      emscape::cuda::check(cudaMemsetAsync(kept.orders.data(), 0, 2 * sizeof(TaskOrder), stream),
                           "cudaMemset");
    }
    launch.order = kept.orders.data() + kept.newest;
    kept.newest = 1 - kept.newest;
    launch.next_order = kept.orders.data() + kept.newest;
  }

 private:
  struct Kept {
    emscape::cuda::Buffer<TaskOrder> orders;  ///< two: one is read while the other is written
    int newest = 0;
  };
  std::map<std::array<int, 4>, Kept> kept_;
};

}  // namespace emscape::render::cuda
