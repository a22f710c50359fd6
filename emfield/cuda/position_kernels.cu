#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/position_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;

constexpr int kThreads = 128;

/// Adds up the threads of a block.
/// @param add(sum, other)
/// @return for thread 0, the sum
template <class Sum, class Add>
__device__ Sum sumOfBlock(const Sum& own, const Add& add) {
  __shared__ __align__(16) unsigned char memory[kThreads * sizeof(Sum)];
  Sum* const sums = reinterpret_cast<Sum*>(memory);
  const int thread = static_cast<int>(threadIdx.x);
  sums[thread] = own;
  for (int half = kThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (thread < half) add(sums[thread], sums[thread + half]);
  }
  return sums[thread];
}

/// Calls visit(c) for the positions of a thread.
template <class Visit>
__device__ void eachPosition(int positions, const Visit& visit) {
  const int threads = static_cast<int>(gridDim.x * blockDim.x);
  for (int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x); c < positions; c += threads) visit(c);
}

__global__ void __launch_bounds__(kThreads)
    positionsKernel(const __grid_constant__ PositionTask task, int positions, GeoidCells geoid,
                    PositionsPart* parts) {
  PositionsPart own;
  eachPosition(positions, [&](int c) { task(c, geoid, own); });
  const PositionsPart all =
      sumOfBlock(own, [](PositionsPart& sum, const PositionsPart& other) { sum.add(other); });
  if (threadIdx.x == 0) parts[blockIdx.x] = all;
}

__global__ void __launch_bounds__(kThreads)
    spanKernel(const __grid_constant__ PositionTask task, int positions, PositionColumn middle,
               const __grid_constant__ FastGeodesy geodesy, double* beyond_m) {
  double own_m = 0;
  eachPosition(positions, [&](int c) {
    if (isLeftOut(task.positions[c])) {
      task.columns[c] = middle;
      return;
    }
    if (task.has_terrain && isnan(task.ground_msl_m[c])) return;
    own_m = fmax(own_m, fastInverse(geodesy, task.columns[c].foot_ecef_m).distance_m);
  });
  const double all_m =
      sumOfBlock(own_m, [](double& most_m, double other_m) { most_m = fmax(most_m, other_m); });
  if (threadIdx.x == 0) beyond_m[blockIdx.x] = all_m;
}

}  // namespace

void computePositions(const PositionTask& task, int positions, const GeoidView& geoid, PositionsPart* parts,
                      cudaStream_t stream) {
  positionsKernel<<<kPositionsParts, kThreads, 0, stream>>>(task, positions, GeoidCells{geoid}, parts);
  checkLaunch("places");
}

void spanPositions(const PositionTask& task, int positions, const PositionColumn& middle,
                   const FastGeodesy& geodesy, double* beyond_m, cudaStream_t stream) {
  spanKernel<<<kPositionsParts, kThreads, 0, stream>>>(task, positions, middle, geodesy, beyond_m);
  checkLaunch("spanOfPositions");
}

}  // namespace emscape::emfield::cuda
