#include <cuda_runtime_api.h>

#include "base/device.h"

namespace emscape {

Device findDevice() {
  Device device;
  int count = 0;
  cudaError_t status = cudaGetDeviceCount(&count);
  cudaDeviceProp properties{};
  if (status == cudaSuccess && count == 0) status = cudaErrorNoDevice;
  if (status == cudaSuccess) status = cudaGetDeviceProperties(&properties, 0);
  if (status == cudaSuccess) status = cudaSetDevice(0);
  if (status == cudaSuccess) status = cudaMemGetInfo(&device.free_bytes, &device.total_bytes);
  if (status != cudaSuccess) {
    device.why_not = cudaGetErrorString(status);
    cudaGetLastError();  // takes the error back
    return device;
  }
  device.usable = true;
  device.name = properties.name;
  return device;
}

}  // namespace emscape
