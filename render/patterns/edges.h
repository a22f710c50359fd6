/// Smoothing of an exact picture: its pixels at edges, and the rays whose mean they become. Single source for
/// host and device.
///
/// An edge is where neighbouring pixels differ: silhouettes of the ground, of isosurfaces, planes and bands
/// of colours. Colours are averaged as they are composited: premultiplied and without conversion to linear
/// light.
#pragma once

#include <array>
#include <vector>

#include "render/cast/raycast.h"
#include "render/patterns/reconstruction.h"

namespace emscape::render {

/// Rays of a pixel at an edge.
constexpr int kEdgeRays = 4;

/// The camera of one of them, 0 <= n < kEdgeRays: shifted by a part of a pixel, so that the rays of a pixel
/// have four different positions along each axis.
EMSCAPE_HD inline CameraView edgeCamera(const CameraView& camera, int n) {
  constexpr int kEighths[kEdgeRays][2] = {{-1, -3}, {3, -1}, {1, 3}, {-3, 1}};
  CameraView shifted = camera;
  shifted.shift_x += kEighths[n][0] / (4.0 * camera.size.height);
  shifted.shift_y -= kEighths[n][1] / (4.0 * camera.size.height);
  return shifted;
}

/// Contrast of a pixel: the largest difference of a channel from one of its four neighbours, in levels of
/// 255.
/// @param at  at(x, y): the four bytes of a pixel of the quantised, premultiplied picture
template <class At>
EMSCAPE_HD int contrast_levels(ImageSize size, int x, int y, const At& at) {
  const auto* const here = at(x, y);
  int largest = 0;
  const auto compare = [&](int other_x, int other_y) {
    if (other_x < 0 || other_y < 0 || other_x >= size.width || other_y >= size.height) return;
    const auto* const other = at(other_x, other_y);
    for (int c = 0; c < 4; ++c) {
      const int difference = here[c] > other[c] ? here[c] - other[c] : other[c] - here[c];
      largest = difference > largest ? difference : largest;
    }
  };
  compare(x - 1, y);
  compare(x + 1, y);
  compare(x, y - 1);
  compare(x, y + 1);
  return largest;
}

/// Number of pixels of each contrast.
using ContrastCounts = std::array<unsigned, 256>;

/// The number of pixels that are smoothed at most, which bounds the time: a 64th of the picture, or of a
/// small one the pixels of some silhouettes.
long long maxEdgePixels(ImageSize size);
/// The smallest contrast of an edge (levels): 12, or more where that would be too many pixels; 256: there are
/// no edges.
int edgeContrast_levels(const ContrastCounts& counts, ImageSize size);

/// The pixels at edges, in an order in which neighbours in the picture are close together.
std::vector<Pixel> edgePixels(const Image& picture);

}  // namespace emscape::render
