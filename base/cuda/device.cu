#include <cuda_runtime_api.h>

#include <atomic>
#include <mutex>
#include <string>

#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"

namespace emscape {
namespace {

/// A GPU that can run this kernel can run all others, which are compiled for the same architectures.
__global__ void answer() {}

std::atomic<int> device_limit{1};

std::string whyNot(cudaError_t status) {
  int driver = 0;
  if (status == cudaErrorInsufficientDriver && cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) {
    return "there is no NVIDIA driver";
  }
  return cudaGetErrorString(status);
}

/// The name of device 0. Its other properties, which take the driver milliseconds, are read once.
cudaError_t readName(std::string& name) {
  static std::mutex of_known;
  static std::string known;
  const std::lock_guard<std::mutex> lock(of_known);
  if (known.empty()) {
    cudaDeviceProp properties{};
    const cudaError_t status = cudaGetDeviceProperties(&properties, 0);
    if (status != cudaSuccess) return status;
    known = properties.name;
  }
  name = known;
  return cudaSuccess;
}

}  // namespace

std::string cudaOfBuild() {
  return "CUDA " + std::to_string(CUDART_VERSION / 1000) + "." + std::to_string(CUDART_VERSION % 1000 / 10) +
         " for " EMSCAPE_CUDA_ARCHITECTURES;
}

Device findDevice() {
  Device device;
  int count = 0, current = 0;
  cudaError_t status = cudaGetDeviceCount(&count);
  cudaFuncAttributes attributes{};
  if (status == cudaSuccess && count == 0) status = cudaErrorNoDevice;
  if (status == cudaSuccess) status = readName(device.name);
  if (status == cudaSuccess) status = cudaGetDevice(&current);
  if (status == cudaSuccess) status = cudaSetDevice(current);
  if (status == cudaSuccess) status = cudaFuncGetAttributes(&attributes, answer);
  if (status == cudaSuccess) status = cudaMemGetInfo(&device.free_bytes, &device.total_bytes);
  if (status != cudaSuccess) {
    device.name.clear();
    device.why_not = whyNot(status);
    cudaGetLastError();  // clears the sticky error
    return device;
  }
  device.usable = true;
  return device;
}

void setDeviceLimit(int devices) {
  device_limit = devices;
}

int deviceCount() {
  int present = 0;
  if (cudaGetDeviceCount(&present) != cudaSuccess) cudaGetLastError();  // clears the sticky error
  const int limit = device_limit;
  if (limit > present) {
    throw Error(ErrorCode::device, "--devices " + std::to_string(limit) + ": this system has " +
                                       std::to_string(present) + (present == 1 ? " GPU" : " GPUs"));
  }
  return limit == 0 ? present : limit;
}

}  // namespace emscape
