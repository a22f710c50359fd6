/// Times of marches on a GPU, for benchmarks.
#pragma once

#include <optional>
#include <vector>

#include "propagation/parabolic_equation/march/march_azimuths.h"

namespace emscape::propagation {

struct GpuMarchTime {
  double device_ms = 0;  ///< from the first copy to the GPU to the end of the last kernel
  double wall_ms = 0;    ///< from the call to the same end, including preparation on the host
};

/// Marches one emitter after the other on one stream; the losses stay on the GPU.
/// @return one per repeat, after a warm-up run
/// @throws as marchAzimuthsOnGpu()
std::vector<GpuMarchTime> timeMarchesOnGpu(const std::vector<AzimuthMarch>& emitters, int repeats);

/// cuFFT's share of a march by its method: forward and inverse transforms of `points` complex floats, `batch`
/// of them at once, without screens and propagator, as one graph.
/// @return ms of all steps, the fastest of three runs; none if libcufft is not found
/// @throws Error (device) without CUDA or a GPU
std::optional<double> timeCufft(int points, int batch, int steps);

}  // namespace emscape::propagation
