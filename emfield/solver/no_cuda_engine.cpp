#include "emfield/solver/field_engine.h"
#include "emscape/base/error.h"

namespace emscape::emfield {

std::unique_ptr<FieldEngine> makeCudaEngine(const FieldSetup&, int, volume::VoxelPrecision) {
  throw Error(ErrorCode::device, "the field on a GPU: this build has no CUDA");
}

}  // namespace emscape::emfield
