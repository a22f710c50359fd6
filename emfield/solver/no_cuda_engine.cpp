#include "emfield/solver/field_engine.h"
#include "emscape/base/error.h"

namespace emscape::emfield {

std::unique_ptr<FieldEngine> makeCudaEngine(const FieldSetup&, int, volume::VoxelPrecision) {
  throw Error(ErrorCode::device, "the field on a GPU: this build has no CUDA");
}

GridColumns makeDeviceColumns(const Surface&, const scenario::Terrain*) {
  throw Error(ErrorCode::device, "the field on a GPU: this build has no CUDA");
}

std::vector<float> groundOf(const cuda::DevicePositions&) {
  return {};
}

}  // namespace emscape::emfield
