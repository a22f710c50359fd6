#include "propagation/parabolic_equation/march/march_timing.h"

#include <dlfcn.h>

#include "base/stopwatch.h"
#include "propagation/cuda/march_cuda.h"

namespace emscape::propagation {
namespace {

using cuda::check;

/// The functions of libcufft that are called; the library is opened at the first call, so that no program is
/// linked with it. Handles and results are plain integers in its interface.
struct Cufft {
  int (*plan1d)(int* plan, int points, int type, int batch) = nullptr;
  int (*setStream)(int plan, cudaStream_t stream) = nullptr;
  int (*execC2C)(int plan, void* in, void* out, int direction) = nullptr;
  int (*destroy)(int plan) = nullptr;
  static constexpr int kC2C = 0x29, kForward = -1, kInverse = 1;

  /// @return false if there is no such library
  bool open() {
    void* library = nullptr;
    for (const char* name :
         {"libcufft.so.12", "libcufft.so.11", "libcufft.so", "/usr/local/cuda/lib64/libcufft.so"}) {
      if (library == nullptr) library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
    if (library == nullptr) return false;
    const auto find = [&](auto& function, const char* name) {
      function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
      return function != nullptr;
    };
    return find(plan1d, "cufftPlan1d") && find(setStream, "cufftSetStream") &&
           find(execC2C, "cufftExecC2C") && find(destroy, "cufftDestroy");
  }
};

}  // namespace

std::vector<GpuMarchTime> timeMarchesOnGpu(const std::vector<AzimuthMarch>& emitters, int repeats) {
  AzimuthMarchCuda cuda_march;
  cuda::Stream stream;
  std::vector<cuda::Buffer<float>> planes;
  for (const AzimuthMarch& march : emitters) planes.emplace_back(march.cellCount());
  std::vector<GpuMarchTime> times;
  for (int repeat = -1; repeat < repeats; ++repeat) {
    cuda::Timer timer;
    Stopwatch watch;
    timer.begin(stream);
    for (std::size_t i = 0; i < emitters.size(); ++i) cuda_march.start(emitters[i], planes[i].data(), stream);
    timer.end(stream);
    const double device_ms = timer.elapsed_ms();
    if (repeat >= 0) times.push_back({device_ms, watch.lap_ms()});
  }
  return times;
}

std::optional<double> timeCufft(int points, int batch, int steps) {
  check(cudaFree(nullptr), "cudaFree");  // fails without a GPU
  Cufft cufft;
  if (!cufft.open()) return std::nullopt;
  cuda::Stream stream;
  cuda::Buffer<StoredComplex> data(std::size_t(points) * std::size_t(batch));
  check(cudaMemsetAsync(data.data(), 0, data.size() * sizeof(StoredComplex), stream), "cudaMemsetAsync");
  int plan = 0;
  if (cufft.plan1d(&plan, points, Cufft::kC2C, batch) != 0) return std::nullopt;
  cufft.setStream(plan, stream);
  stream.wait();
  constexpr int kStepsOfGraph = 100;
  cudaGraph_t graph = nullptr;
  cudaGraphExec_t executable = nullptr;
  check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
  for (int i = 0; i < kStepsOfGraph; ++i) {
    cufft.execC2C(plan, data.data(), data.data(), Cufft::kForward);
    cufft.execC2C(plan, data.data(), data.data(), Cufft::kInverse);
  }
  check(cudaStreamEndCapture(stream, &graph), "cudaStreamEndCapture");
  check(cudaGraphInstantiate(&executable, graph, 0), "cudaGraphInstantiate");
  double fastest_ms = 0;
  for (int run = -1; run < 3; ++run) {
    cuda::Timer timer;
    timer.begin(stream);
    check(cudaGraphLaunch(executable, stream), "cudaGraphLaunch");
    timer.end(stream);
    const double ms = timer.elapsed_ms() * steps / kStepsOfGraph;
    if (run == 0 || (run > 0 && ms < fastest_ms)) fastest_ms = ms;
  }
  cudaGraphExecDestroy(executable);
  cudaGraphDestroy(graph);
  cufft.destroy(plan);
  return fastest_ms;
}

}  // namespace emscape::propagation
