/// Finished pictures in GPU memory, and their transfer to OpenGL without a copy through the host.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/render/picture/image.h"

namespace emscape::render {

/// A picture with 8 bits per channel in GPU memory. Immutable; threads may share it.
class DevicePicture {
 public:
  virtual ~DevicePicture() = default;
  virtual ImageSize size() const = 0;
  /// A copy in the host's memory. @throws Error (device)
  virtual Image8 host() const = 0;
};

/// The labels of a picture in two layers, behind and in front of the cast image, for composition on a GPU.
struct OverlayLayers {
  ImageSize size;
  /// Pixels 0xAARRGGBB, premultiplied, row by row from the top. `behind` is opaque.
  std::vector<std::uint32_t> behind, front;
};

/// True if the OpenGL context of the calling thread uses the same GPU as CUDA, so that GlPixelBuffer can be
/// used. False without CUDA, GPU or context.
bool openGlSharesGpu();

/// A pixel buffer object of OpenGL that is filled from pictures on the GPU. The context of the buffer must be
/// current from construction to destruction.
class GlPixelBuffer {
 public:
  /// @param buffer  name of a buffer object with storage of at least 4 * size.count() bytes; it must outlive
  /// this object, and its storage must stay
  /// @throws Error (device) if CUDA cannot use it
  GlPixelBuffer(unsigned buffer, ImageSize size);
  ~GlPixelBuffer();

  /// Copies a picture: bytes r g b a, rows from the top. Returns when the copy is complete.
  /// @param picture  of the size given to the constructor
  /// @throws Error (device); (other) for another size
  void fill(const DevicePicture& picture);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
