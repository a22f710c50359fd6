/// A finished picture in the memory of this process' GPU.
#pragma once

#include <cuda_runtime_api.h>

#include "base/cuda/cuda_memory.h"
#include "emscape/render/picture/device_picture.h"

namespace emscape::render::cuda {

class PictureMemory : public DevicePicture {
 public:
  explicit PictureMemory(ImageSize size) : size_(size), pixels_(static_cast<std::size_t>(size.count())) {}

  ImageSize size() const override { return size_; }
  Image8 host() const override {
    static_assert(sizeof(uchar4) == 4, "a pixel is four bytes");
    Image8 image;
    image.size = size_;
    image.rgba.resize(4 * pixels_.size());
    pixels_.download(reinterpret_cast<uchar4*>(image.rgba.data()), cudaStreamPerThread);
    return image;
  }

  uchar4* pixels() { return pixels_.data(); }
  const uchar4* pixels() const { return pixels_.data(); }
  std::size_t bytes() const { return 4 * pixels_.size(); }

 private:
  ImageSize size_;
  emscape::cuda::Buffer<uchar4> pixels_;
};

}  // namespace emscape::render::cuda
