/// The picture on the screen.
#pragma once

#include "emscape/render/image.h"

namespace emscape::view {

/// A picture of 8 bits a channel, drawn pixel by pixel: nothing is filtered, blended or converted. A context
/// of OpenGL 3.3 must be current from construction to destruction.
class PictureTexture {
 public:
  PictureTexture();
  ~PictureTexture();
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;

  void set(const render::Image8& image);
  bool isSet() const { return size_.count() > 0; }
  /// Draws the picture into the bound framebuffer, stretched to the nearest pixels where the sizes differ.
  /// @param left, bottom, width, height  in pixels of the framebuffer
  void draw(int left, int bottom, int width, int height) const;

 private:
  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;  // whose colours are the texture
  render::ImageSize size_;
};

}  // namespace emscape::view
