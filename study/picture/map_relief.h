/// The ground of a map: relief as lightness, and the sea.
#pragma once

#include <cstdint>
#include <vector>

#include "emscape/render/transfer/transfer_function.h"

namespace emscape::study {

/// Heights of the ground of a map, at the middles of squares; rows from north to south.
struct Relief {
  int width = 0, height = 0;
  double cell_m = 0;                ///< side of a square in the projection
  std::vector<float> ground_msl_m;  ///< NaN: unknown; empty: all

  std::size_t posts() const { return static_cast<std::size_t>(width) * height; }
};

/// Shading by light from the north-west at an elevation of 45 degrees: 0 on level ground, up to 0.3 on slopes
/// towards the light, down to -1.7 on slopes away from it; 0 where the slope is unknown.
std::vector<float> shadesOf(const Relief& relief);

/// Makes land of connected water that is neither as wide nor as high as a number of squares and does not
/// reach the edge of the map.
void dropSmallWater(std::vector<std::uint8_t>& water, int width, int height, int smallest);

/// Largest change of the lightness of a map's colours (OKLab, where black is 0 and white 1) by the relief.
constexpr double kMaxRelief = 0.07;

/// The colour of a value under a shade: hue and chroma are kept, the lightness differs by at most
/// kMaxRelief. Level ground has the colour itself.
render::Rgb shadedColor(const render::Rgb& color, float shade);

/// The colour of a value over a picture on the ground: hue and chroma are kept, the lightness follows that of
/// the picture, by at most kMaxRelief.
render::Rgb drapedColor(const render::Rgb& color, const render::Rgb& picture);

/// The colour of ground, or of the sea, without a value.
render::Rgb groundColor(float shade, bool is_sea);

}  // namespace emscape::study
