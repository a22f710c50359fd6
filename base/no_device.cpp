#include "emscape/base/cuda/device.h"

namespace emscape {

std::string cudaOfBuild() {
  return {};
}

Device findDevice() {
  Device device;
  device.why_not = "this build has no CUDA";
  return device;
}

void setDeviceLimit(int) {}

int deviceCount() {
  return 0;
}

}  // namespace emscape
