#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/combine_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using scenario::PatternKind;

constexpr int kThreads = 128;
constexpr int kLayers = 4;

template <PatternKind kind, bool kReflected, bool kClutter, bool kAge>
__global__ void __launch_bounds__(kThreads)
    radarKernel(const __grid_constant__ RadarPass pass, const std::uint16_t* first_valid_k) {
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (column >= pass.dims.x * pass.dims.y) return;
  const int begin = static_cast<int>(blockIdx.y) * kLayers;
  const int end = begin + kLayers < pass.dims.z ? begin + kLayers : pass.dims.z;
  const int first_valid = first_valid_k == nullptr ? 0 : first_valid_k[column];
  for (int k = begin > first_valid ? begin : first_valid; k < end; ++k) {
    addEcho<kind, kReflected, kClutter, kAge>(pass, static_cast<std::size_t>(column), k);
  }
}

template <PatternKind kind, bool kAge>
void launch(const RadarPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const dim3 blocks(static_cast<unsigned>((pass.dims.x * pass.dims.y + kThreads - 1) / kThreads),
                    static_cast<unsigned>((pass.dims.z + kLayers - 1) / kLayers));
  const auto kernel = kAge || !pass.task.clutter.isNone() ? pass.has_reflected_rays
                                                                ? radarKernel<kind, true, true, kAge>
                                                                : radarKernel<kind, false, true, kAge>
                      : pass.has_reflected_rays ? radarKernel<kind, true, kAge, kAge>
                                                          : radarKernel<kind, false, kAge, kAge>;
  kernel<<<blocks, kThreads, 0, stream>>>(pass, first_valid_k);
  emscape::cuda::checkLaunch("radar");
}

template <bool kAge>
void launchPattern(const RadarPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return launch<PatternKind::isotropic, kAge>(pass, first_valid_k, stream);
    case PatternKind::gaussian:
      return launch<PatternKind::gaussian, kAge>(pass, first_valid_k, stream);
    case PatternKind::separable:
      return launch<PatternKind::separable, kAge>(pass, first_valid_k, stream);
    case PatternKind::phased_array:
      return launch<PatternKind::phased_array, kAge>(pass, first_valid_k, stream);
    case PatternKind::grid:
      return launch<PatternKind::grid, kAge>(pass, first_valid_k, stream);
  }
}

}  // namespace

void addRadar(const RadarPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const bool is_age = pass.task.measure == RadarMeasure::detection_age;
  return is_age ? launchPattern<true>(pass, first_valid_k, stream)
                : launchPattern<false>(pass, first_valid_k, stream);
}

}  // namespace emscape::emfield::cuda
