#include "render/cuda/submission.h"

#include <cstring>

namespace emscape::render::cuda {

using emscape::cuda::check;

FrameGraph::~FrameGraph() {
  for (const auto& [kinds, built] : built_) {
    if (built.executable != nullptr) cudaGraphExecDestroy(built.executable);
    if (built.graph != nullptr) cudaGraphDestroy(built.graph);
  }
}

void FrameGraph::add(const void* kernel, const LaunchShape& shape, const std::vector<const void*>& parameters,
                     const std::vector<std::size_t>& sizes) {
  constexpr std::size_t kUnit = sizeof(std::max_align_t);
  if (count_ == kernels_.size()) kernels_.emplace_back();
  Kernel& added = kernels_[count_++];
  std::size_t units = 0;
  for (const std::size_t size : sizes) units += (size + kUnit - 1) / kUnit;
  added.storage.resize(units);
  added.parameters.clear();
  std::max_align_t* to = added.storage.data();
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    std::memcpy(static_cast<void*>(to), parameters[n], sizes[n]);
    added.parameters.push_back(to);
    to += (sizes[n] + kUnit - 1) / kUnit;
  }
  added.kind = shape.kind;
  added.node.func = const_cast<void*>(kernel);
  added.node.gridDim = shape.grid;
  added.node.blockDim = shape.block;
  added.node.sharedMemBytes = shape.shared_bytes;
  added.node.kernelParams = added.parameters.data();
}

void FrameGraph::submit(cudaStream_t stream) {
  std::vector<LaunchKind> kinds;
  for (std::size_t n = 0; n < count_; ++n) kinds.push_back(kernels_[n].kind);
  Built& built = built_[kinds];
  if (built.executable == nullptr) {
    build(built);
  } else {
    for (std::size_t n = 0; n < count_; ++n) {
      check(cudaGraphExecKernelNodeSetParams(built.executable, built.kernels[n], &kernels_[n].node),
            "cudaGraphExecKernelNodeSetParams");
    }
  }
  check(cudaGraphLaunch(built.executable, stream), "cudaGraphLaunch");
}

namespace {

/// Lets a kernel begin while the one before it ends, where CUDA can; it begins after it otherwise.
void follow(cudaGraph_t graph, cudaGraphNode_t before, cudaGraphNode_t kernel, bool early) {
#if CUDART_VERSION >= 13000
  cudaGraphEdgeData edge{};
  if (early) {
    edge.from_port = cudaGraphKernelNodePortProgrammatic;
    edge.type = cudaGraphDependencyTypeProgrammatic;
  }
  check(cudaGraphAddDependencies(graph, &before, &kernel, &edge, 1), "cudaGraphAddDependencies");
#else
  static_cast<void>(early);
  check(cudaGraphAddDependencies(graph, &before, &kernel, 1), "cudaGraphAddDependencies");
#endif
}

}  // namespace

void FrameGraph::build(Built& built) const {
  check(cudaGraphCreate(&built.graph, 0), "cudaGraphCreate");
  cudaGraphNode_t last = nullptr;
  check(cudaGraphAddEventRecordNode(&last, built.graph, nullptr, 0, begin_.event()),
        "cudaGraphAddEventRecordNode");
  for (std::size_t n = 0; n < count_; ++n) {
    const Kernel& kernel = kernels_[n];
    cudaGraphNode_t node = nullptr;
    check(cudaGraphAddKernelNode(&node, built.graph, nullptr, 0, &kernel.node), "cudaGraphAddKernelNode");
    if (kernel.kind == LaunchKind::together) {
      cudaKernelNodeAttrValue together{};
      together.cooperative = 1;
      check(cudaGraphKernelNodeSetAttribute(node, cudaKernelNodeAttributeCooperative, &together),
            "cudaGraphKernelNodeSetAttribute");
    }
    follow(built.graph, last, node, kernel.kind == LaunchKind::early && n > 0);
    built.kernels.push_back(node);
    last = node;
  }
  cudaGraphNode_t end = nullptr;
  check(cudaGraphAddEventRecordNode(&end, built.graph, &last, 1, end_.event()),
        "cudaGraphAddEventRecordNode");
  check(cudaGraphInstantiate(&built.executable, built.graph, 0), "cudaGraphInstantiate");
}

void Submission::start(const char* name, const void* kernel, const LaunchShape& shape,
                       const std::vector<const void*>& parameters,
                       const std::vector<std::size_t>& sizes) const {
  if (frame_ != nullptr) {
    emscape::cuda::last_kernel = name;
    return frame_->add(kernel, shape, parameters, sizes);
  }
  cudaLaunchAttribute attribute{};
  if (shape.kind == LaunchKind::together) {
    attribute.id = cudaLaunchAttributeCooperative;
    attribute.val.cooperative = 1;
  } else {
    attribute.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    attribute.val.programmaticStreamSerializationAllowed = 1;
  }
  cudaLaunchConfig_t config{};
  config.gridDim = shape.grid;
  config.blockDim = shape.block;
  config.dynamicSmemBytes = shape.shared_bytes;
  config.stream = stream_;
  config.attrs = &attribute;
  config.numAttrs = shape.kind == LaunchKind::plain ? 0 : 1;
  std::vector<void*> places;
  for (const void* parameter : parameters) places.push_back(const_cast<void*>(parameter));
  // What goes wrong is told by checkLaunch(), with the kernel's name.
  static_cast<void>(cudaLaunchKernelExC(&config, kernel, places.data()));
  emscape::cuda::checkLaunch(name);
}

}  // namespace emscape::render::cuda
