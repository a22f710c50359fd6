/// The ground in each pixel of a picture, kept while the camera does not move.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "render/cast/rgba.h"

namespace emscape::render {

/// One entry per pixel, filled when pixels are cast.
struct GroundLayer {
  static constexpr float kUnknown = -1.0F;
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  ImageSize size;
  std::vector<float> distances;  ///< along the ray; kNone: it misses the ground; kUnknown: not yet computed
  std::vector<Rgba> colors;      ///< of hits
  bool complete = false;         ///< no pixel is unknown

  void reset(ImageSize image_size) {
    size = image_size;
    distances.assign(static_cast<std::size_t>(size.count()), kUnknown);
    colors.resize(distances.size());
    complete = false;
  }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * size.width + x; }
  /// The colour of a pixel whose volume has the colour `front`. Its ground must be known.
  Rgba behind(const Rgba& front, std::size_t pixel) const {
    return distances[pixel] < kNone ? over(front, colors[pixel]) : front;
  }
};

}  // namespace emscape::render
