#include "emscape/base/error.h"
#include "propagation/parabolic_equation/march/march_azimuths.h"
#include "propagation/parabolic_equation/march/march_timing.h"

namespace emscape::propagation {
namespace {

[[noreturn]] void refuse() {
  throw Error(ErrorCode::device, "the parabolic equation on a GPU: this build has no CUDA");
}

}  // namespace

void marchAzimuthsOnGpu(const AzimuthMarch&, float*) {
  refuse();
}
std::vector<FieldColumn> columnsOnGpu(const AzimuthMarch&, const std::vector<int>&) {
  refuse();
}
std::vector<GpuMarchTime> timeMarchesOnGpu(const std::vector<AzimuthMarch>&, int) {
  refuse();
}
std::optional<double> timeCufft(int, int, int) {
  refuse();
}

}  // namespace emscape::propagation
