/// A picture put together from its layers, pixel by pixel.
#pragma once

#include <cstring>

#include "emscape/render/picture/device_picture.h"
#include "render/picture/bytes_over.h"

namespace emscape::render::testing {

inline Image8 putTogether(const Image8& cast, const OverlayLayers& layers) {
  Image8 picture = cast;
  for (std::size_t i = 0; i < layers.behind.size(); ++i) {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, &cast.rgba[4 * i], 4);
    pixel = bytesOver(layers.front[i], bytesOver(redAndBlueSwapped(pixel), layers.behind[i]));
    pixel = redAndBlueSwapped(pixel);
    std::memcpy(&picture.rgba[4 * i], &pixel, 4);
  }
  return picture;
}

}  // namespace emscape::render::testing
