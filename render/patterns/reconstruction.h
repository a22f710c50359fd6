/// The patterns of pixel interpolation: cast pixels, and interpolation of the others.
#pragma once

#include <cstdint>
#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/frame.h"

namespace emscape::render {

/// A pixel of a list to be cast.
struct Pixel {
  std::uint16_t x = 0, y = 0;
};

/// Pixels (first_x + i * step_x, first_y + j * step_y), 0 <= i < columns, 0 <= j < rows: a dense launch casts
/// one.
struct Lattice {
  int first_x = 0, first_y = 0;
  int step_x = 1, step_y = 1;
  int columns = 0, rows = 0;

  EMSCAPE_HD long long count() const { return static_cast<long long>(columns) * rows; }
};

/// The source pixels of a pattern, and the remaining pixels; together they are the image, each pixel once.
/// Empty lattices are left out. None for adaptive.
std::vector<Lattice> sourceLattices(Pattern pattern, ImageSize size);
std::vector<Lattice> missingLattices(Pattern pattern, ImageSize size);
long long pixelCount(const std::vector<Lattice>& lattices);

/// Interpolates every pixel that is not a source pixel. An edge pixel with one neighbour copies it. 8-bit
/// interpolation rounds half up and does not change source pixels. No effect for adaptive.
void interpolate(Pattern pattern, Interpolation interpolation, Image& image);

}  // namespace emscape::render
