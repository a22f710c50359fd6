/// Pictures from CUDA to OpenGL: not available in a build without CUDA.
#include "emscape/base/error.h"
#include "emscape/render/picture/device_picture.h"

namespace emscape::render {

bool openGlSharesGpu() {
  return false;
}

struct GlPixelBuffer::Impl {};

GlPixelBuffer::GlPixelBuffer(unsigned /*buffer*/, ImageSize /*size*/) {
  throw Error(ErrorCode::device, "pictures from the GPU to OpenGL: this build has no CUDA");
}
GlPixelBuffer::~GlPixelBuffer() = default;
void GlPixelBuffer::fill(const DevicePicture& /*picture*/) {}

}  // namespace emscape::render
