/// Frames cast by a GPU: not available in a build without CUDA.
#include "emscape/base/error.h"
#include "render/scene/frame_caster.h"

namespace emscape::render {

std::unique_ptr<FrameCaster> makeCudaCaster(volume::VoxelPrecision /*precision*/) {
  throw Error(ErrorCode::device, "pictures cast by the GPU: this build has no CUDA");
}

}  // namespace emscape::render
