/// The picture on the screen: three textures, one over the other.
#pragma once

#include <array>

#include "emscape/render/image.h"

namespace emscape::view {

/// Pictures of 8 bits a channel, premultiplied, drawn pixel by pixel: nothing is filtered, nothing is
/// converted. A context of OpenGL 3.3 must be current from construction to destruction.
class PictureLayers {
 public:
  static constexpr int kCount = 3;

  PictureLayers();
  ~PictureLayers();
  PictureLayers(const PictureLayers&) = delete;
  PictureLayers& operator=(const PictureLayers&) = delete;

  /// @param layer  0 (below) .. kCount - 1
  void set(int layer, const render::Image8& image);
  /// Draws the layers that were set, from the lowest on.
  /// @param left, bottom, width, height  in pixels of the framebuffer
  void draw(int left, int bottom, int width, int height) const;

 private:
  unsigned program_ = 0;
  unsigned vertices_ = 0;
  std::array<unsigned, kCount> textures_{};
  std::array<render::ImageSize, kCount> sizes_{};
};

}  // namespace emscape::view
