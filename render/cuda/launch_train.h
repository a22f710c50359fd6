/// Launches one after another that can be stopped in between. For the neighbours of .cu files.
#pragma once

#include "base/cuda/cuda_memory.h"
#include "emscape/base/progress.h"

namespace emscape::render::cuda {

/// With somebody who may stop it, only so much is launched ahead as keeps the GPU busy: two launches of at
/// most mostRays() rays. Without, nothing is cut.
class LaunchTrain {
 public:
  LaunchTrain(cudaStream_t stream, const StopFlag* stop, long long most_rays)
      : stream_(stream), stop_(stop), most_rays_(most_rays) {}

  /// Rays of a launch.
  long long mostRays() const { return stop_ != nullptr ? most_rays_ : kAll; }

  /// Before each launch: waits until at most one runs. @return false: stopped
  bool goOn() {
    if (stop_ == nullptr) return true;
    if (launches_ >= 2) ends_[launches_ % 2].wait();
    return !stop_->load(std::memory_order_relaxed);
  }
  /// After each.
  void launched() {
    if (stop_ != nullptr) ends_[launches_++ % 2].record(stream_);
  }

 private:
  static constexpr long long kAll = 1LL << 62;

  const cudaStream_t stream_;
  const StopFlag* const stop_;
  const long long most_rays_;
  emscape::cuda::Event ends_[2];
  int launches_ = 0;
};

}  // namespace emscape::render::cuda
