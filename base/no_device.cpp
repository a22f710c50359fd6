#include "base/device.h"

namespace emscape {

Device findDevice() {
  Device device;
  device.why_not = "this build has no CUDA";
  return device;
}

}  // namespace emscape
