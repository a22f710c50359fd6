/// Pictures from CUDA to OpenGL, on one GPU.
#include <GL/gl.h>
// before the header that needs its types
#include <cuda_gl_interop.h>

#include <algorithm>
#include <array>

#include "emscape/base/error.h"
#include "render/cuda/picture_memory.h"

namespace emscape::render {

using emscape::cuda::check;

bool openGlSharesGpu() {
  std::array<int, 16> devices{};
  unsigned count = 0;
  int own = 0;
  const bool is_known = cudaGetDevice(&own) == cudaSuccess &&
                        cudaGLGetDevices(&count, devices.data(), static_cast<unsigned>(devices.size()),
                                         cudaGLDeviceListAll) == cudaSuccess;
  cudaGetLastError();  // clears the error: no GPU, or not that of this context
  const auto* end = devices.begin() + std::min<std::size_t>(count, devices.size());
  return is_known && std::find(devices.cbegin(), end, own) != end;
}

struct GlPixelBuffer::Impl {
  ImageSize size;
  cudaGraphicsResource_t resource = nullptr;
  emscape::cuda::Stream stream;

  ~Impl() {
    if (resource != nullptr) cudaGraphicsUnregisterResource(resource);
  }
};

GlPixelBuffer::GlPixelBuffer(unsigned buffer, ImageSize size) : impl_(std::make_unique<Impl>()) {
  impl_->size = size;
  check(cudaGraphicsGLRegisterBuffer(&impl_->resource, buffer, cudaGraphicsRegisterFlagsWriteDiscard),
        "cudaGraphicsGLRegisterBuffer");
}

GlPixelBuffer::~GlPixelBuffer() = default;

void GlPixelBuffer::fill(const DevicePicture& picture) {
  const auto* memory = dynamic_cast<const cuda::PictureMemory*>(&picture);
  if (memory == nullptr || memory->size() != impl_->size) {
    throw Error(ErrorCode::other, "GlPixelBuffer: the picture has not the buffer's size");
  }
  check(cudaGraphicsMapResources(1, &impl_->resource, impl_->stream), "cudaGraphicsMapResources");
  void* to = nullptr;
  std::size_t bytes = 0;
  cudaError_t status = cudaGraphicsResourceGetMappedPointer(&to, &bytes, impl_->resource);
  if (status == cudaSuccess) {
    status = cudaMemcpyAsync(to, memory->pixels(), std::min(bytes, memory->bytes()), cudaMemcpyDeviceToDevice,
                             impl_->stream);
  }
  // In any case, because OpenGL must not use mapped buffers.
  const cudaError_t unmapped = cudaGraphicsUnmapResources(1, &impl_->resource, impl_->stream);
  check(status, "copying a picture to OpenGL");
  check(unmapped, "cudaGraphicsUnmapResources");
  impl_->stream.wait();  // then the picture's memory may be reused
}

}  // namespace emscape::render
