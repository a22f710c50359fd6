/// How kernels are launched.
#pragma once

#include <cuda_runtime_api.h>

#include <vector>

namespace emscape::render::cuda {

enum class LaunchKind {
  plain,
  together,  ///< its blocks wait for each other: all of them run at a time
  early      ///< may be started while the kernel before it ends, and waits for that by itself
};

struct LaunchShape {
  dim3 grid, block;
  unsigned shared_bytes = 0;  ///< beside what the kernel itself declares
  LaunchKind kind = LaunchKind::plain;
};

class Submission {
 public:
  explicit Submission(cudaStream_t stream) : stream_(stream) {}

  /// @throws Error (device) that names the kernel
  template <class... Parameters>
  void start(const char* name, void (*kernel)(Parameters...), const LaunchShape& shape,
             Parameters... parameters) const {
    start(name, reinterpret_cast<const void*>(kernel), shape, {&parameters...});
  }

 private:
  void start(const char* name, const void* kernel, const LaunchShape& shape,
             const std::vector<const void*>& parameters) const;

  cudaStream_t stream_;
};

}  // namespace emscape::render::cuda
