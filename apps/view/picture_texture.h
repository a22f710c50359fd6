/// The picture on the screen.
#pragma once

#include <memory>

#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"

namespace emscape::view {

/// A picture of 8 bits per channel, drawn without filtering, blending or conversion. An OpenGL 3.3 context
/// must be current from construction to destruction.
class PictureTexture {
 public:
  PictureTexture();
  ~PictureTexture();
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  void set(const render::Image8& image);
  /// Sets a picture in the memory of the GPU that also runs OpenGL. @throws Error (device); the previous
  /// picture is kept
  void set(const render::DevicePicture& picture);
  bool isSet() const { return size_.count() > 0; }
  render::ImageSize size() const { return size_; }
  /// Draws the picture into the bound framebuffer, scaled with nearest-pixel sampling if the sizes differ.
  /// @param left, bottom, width, height  in pixels of the framebuffer
  void draw(int left, int bottom, int width, int height) const;

 private:
  /// Reads the pixels from memory, or from the bound unpack buffer if `pixels` is null.
  void setPixels(render::ImageSize size, const void* pixels);

  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;  // with the texture as colour attachment
  render::ImageSize size_;
  unsigned buffer_ = 0;  // between CUDA and the texture
  render::ImageSize buffer_size_;
  std::unique_ptr<render::GlPixelBuffer> shared_buffer_;
};

}  // namespace emscape::view
