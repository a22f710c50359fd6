/// Finished pictures in the memory of a GPU, and their way to OpenGL without the host's memory.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/render/image.h"

namespace emscape::render {

/// A picture of 8 bits a channel in the memory of a GPU. Does not change; may be used by any thread.
class DevicePicture {
 public:
  virtual ~DevicePicture() = default;
  virtual ImageSize size() const = 0;
  /// A copy in the host's memory. @throws Error (device)
  virtual Image8 host() const = 0;
};

/// The labels of a picture in two layers, behind what is cast and in front of it: for composing a picture on
/// a GPU.
struct OverlayLayers {
  ImageSize size;
  /// Pixels 0xAARRGGBB, premultiplied, row by row from the top. `behind` is opaque.
  std::vector<std::uint32_t> behind, front;
};

/// Whether the OpenGL context of the calling thread draws with the GPU that CUDA computes on, so that
/// GlPixelBuffer can be used. False where there is no CUDA, no GPU, or no context.
bool openGlSharesGpu();

/// A pixel buffer object of OpenGL that is filled from pictures on the GPU. From construction to destruction
/// the context that the buffer belongs to must be current.
class GlPixelBuffer {
 public:
  /// @param buffer  name of a buffer object with storage of at least 4 * size.count() bytes; it must outlive
  /// this object, and its storage must stay
  /// @throws Error (device) if CUDA cannot use it
  GlPixelBuffer(unsigned buffer, ImageSize size);
  ~GlPixelBuffer();

  /// Copies a picture: bytes r g b a, rows from the top. Returns when it is there.
  /// @param picture  of the size given above
  /// @throws Error (device); (other) for another size
  void fill(const DevicePicture& picture);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::render
