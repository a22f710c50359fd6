/// The ground in each pixel of a picture, kept while the camera does not move.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/large_array.h"
#include "render/cast/rgba.h"

namespace emscape::render {

/// One entry per pixel, filled when pixels are cast.
struct GroundLayer {
  static constexpr float kUnknown = -1.0F;
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  ImageSize size;
  std::vector<float> distances;  ///< along the ray; kNone: it misses the ground; kUnknown: not yet computed
  std::vector<Rgba> colors;      ///< of hits
  std::vector<std::uint8_t> is_surface;  ///< of hits: see GroundHit
  std::vector<Rgba> mapped;              ///< colours of hits with the map layer; empty without one
  std::vector<std::uint8_t> is_mapped;   ///< the colour in `mapped` is known
  bool complete = false;                 ///< no pixel is unknown

  /// @throws Stopped
  void reset(ImageSize image_size) {
    size = {};
    complete = false;
    dropMap();
    distances.clear();
    resizeInParts(distances, static_cast<std::size_t>(image_size.count()), kUnknown);
    resizeInParts(colors, distances.size());
    resizeInParts(is_surface, distances.size());
    size = image_size;
  }
  void dropMap() {
    mapped.clear();
    is_mapped.clear();
  }
  /// @throws Stopped
  void beginMap() {
    if (is_mapped.size() == colors.size()) return;
    is_mapped.clear();
    resizeInParts(mapped, colors.size());
    resizeInParts(is_mapped, colors.size());
  }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * size.width + x; }
};

}  // namespace emscape::render
