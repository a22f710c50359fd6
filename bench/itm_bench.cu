// ITM, point-to-point, on a GPU: difference from the CPU in double precision, and evaluations per second for
// profiles of 300 posts.
//
//   nvcc -std=c++17 -O2 -arch=sm_90 -I. bench/itm_bench.cu -o itm_bench_cuda && ./itm_bench_cuda
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "apps/bench/itm_cases.h"

namespace {

using namespace emscape;

constexpr int kCases = 20000;
constexpr int kIntervals = 299;
constexpr double kStep_m = 90;
constexpr int kRepeats = 10;

void require(cudaError_t status) {
  if (status == cudaSuccess) return;
  std::fprintf(stderr, "itm_bench_cuda: %s\n", cudaGetErrorString(status));
  std::exit(4);
}

template <class T>
T* onDevice(const std::vector<T>& values) {
  T* copy = nullptr;
  require(cudaMalloc(&copy, values.size() * sizeof(T)));
  require(cudaMemcpy(copy, values.data(), values.size() * sizeof(T), cudaMemcpyHostToDevice));
  return copy;
}

template <class Real>
__global__ void evaluate(const float* heights_msl_m, const propagation::ItmLink<Real>* links, Real* loss_db) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= kCases) return;
  const propagation::ItmProfile<float> profile{heights_msl_m + static_cast<std::size_t>(i) * (kIntervals + 1),
                                               kIntervals, kStep_m};
  loss_db[i] = propagation::itmPointToPoint(profile, links[i], propagation::ItmQuantiles<Real>()).loss_db;
}

template <class Real>
void measure(const char* name, const bench::ItmCases& cases) {
  std::vector<propagation::ItmLink<Real>> links;
  for (const auto& link : cases.links) links.push_back(bench::linkAs<Real>(link));
  const float* heights = onDevice(cases.heights_msl_m);
  const propagation::ItmLink<Real>* device_links = onDevice(links);
  std::vector<Real> loss_db(kCases);
  Real* device_loss = onDevice(loss_db);

  cudaEvent_t begin, end;
  require(cudaEventCreate(&begin));
  require(cudaEventCreate(&end));
  constexpr int kThreads = 128;
  const auto launch = [&] {
    evaluate<Real><<<(kCases + kThreads - 1) / kThreads, kThreads>>>(heights, device_links, device_loss);
  };
  launch();
  require(cudaEventRecord(begin));
  for (int repeat = 0; repeat < kRepeats; ++repeat) launch();
  require(cudaEventRecord(end));
  require(cudaEventSynchronize(end));
  float ms = 0;
  require(cudaEventElapsedTime(&ms, begin, end));
  require(cudaMemcpy(loss_db.data(), device_loss, kCases * sizeof(Real), cudaMemcpyDeviceToHost));

  double largest_db = 0;
  for (int i = 0; i < kCases; ++i) {
    const propagation::ItmProfile<float> profile{cases.profile(static_cast<std::size_t>(i)), kIntervals,
                                                 kStep_m};
    const double expected_db =
        propagation::itmPointToPoint(profile, cases.links[i], propagation::ItmQuantiles<double>()).loss_db;
    largest_db = std::max(largest_db, std::fabs(static_cast<double>(loss_db[i]) - expected_db));
  }
  std::printf("%s: %.1f million evaluations/s; within %.2g dB of the CPU's double\n", name,
              1e-3 * kCases * kRepeats / ms, largest_db);
}

}  // namespace

int main() {
  cudaDeviceProp device;
  require(cudaGetDeviceProperties(&device, 0));
  std::printf("ITM point-to-point, %d posts, %s\n", kIntervals + 1, device.name);
  const bench::ItmCases cases = bench::makeItmCases(kCases, kIntervals);
  measure<double>("double", cases);
  measure<float>("float", cases);
}
