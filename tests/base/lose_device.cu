#include "base/cuda/cuda_memory.h"
#include "tests/base/lose_device.h"

namespace emscape::test {
namespace {

__global__ void fault() {
  __trap();
}

}  // namespace

void loseDevice() {
  fault<<<1, 1>>>();
  cuda::checkLaunch("fault");
}

}  // namespace emscape::test
