/// How kernels come to the GPU: one by one, or all those of a frame as a whole.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <map>
#include <vector>

#include "base/cuda/cuda_memory.h"

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

/// The kernels of a frame between two marks, given to the GPU at once: it never waits for the host between
/// them.
class FrameGraph {
 public:
  /// @param begin, end  are recorded before the first kernel and after the last
  FrameGraph(const emscape::cuda::TimeMark& begin, const emscape::cuda::TimeMark& end)
      : begin_(begin), end_(end) {}
  ~FrameGraph();
  FrameGraph(const FrameGraph&) = delete;
  FrameGraph& operator=(const FrameGraph&) = delete;

  void begin() { count_ = 0; }
  /// @param parameters, sizes  of the kernel's parameters, which are copied
  void add(const void* kernel, const LaunchShape& shape, const std::vector<const void*>& parameters,
           const std::vector<std::size_t>& sizes);
  /// What was added since begin(), in that order.
  void submit(cudaStream_t stream);

 private:
  struct Kernel {
    cudaKernelNodeParams node{};
    LaunchKind kind = LaunchKind::plain;
    std::vector<std::max_align_t> storage;
    std::vector<void*> parameters;
  };
  struct Built {
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t executable = nullptr;
    std::vector<cudaGraphNode_t> kernels;
  };
  void build(Built& built) const;

  const emscape::cuda::TimeMark& begin_;
  const emscape::cuda::TimeMark& end_;
  std::vector<Kernel> kernels_;  ///< the first count_ of them
  std::size_t count_ = 0;
  std::map<std::vector<LaunchKind>, Built> built_;  ///< frames alike but for kernels and parameters
};

class Submission {
 public:
  /// @param frame  what kernels are added to; null: they are started on the stream
  explicit Submission(cudaStream_t stream, FrameGraph* frame = nullptr) : stream_(stream), frame_(frame) {}

  /// @throws Error (device) that names the kernel
  template <class... Parameters>
  void start(const char* name, void (*kernel)(Parameters...), const LaunchShape& shape,
             Parameters... parameters) const {
    start(name, reinterpret_cast<const void*>(kernel), shape, {&parameters...}, {sizeof(Parameters)...});
  }

 private:
  void start(const char* name, const void* kernel, const LaunchShape& shape,
             const std::vector<const void*>& parameters, const std::vector<std::size_t>& sizes) const;

  cudaStream_t stream_;
  FrameGraph* frame_;
};

}  // namespace emscape::render::cuda
