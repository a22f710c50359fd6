/// The ground of a map: relief as lightness, and the sea.
#pragma once

#include <cstdint>
#include <vector>

#include "emscape/render/transfer/transfer_function.h"
#include "emscape/study/maps/map_grid.h"

namespace emscape::study {

/// Shading of a map's pixels by light from the north-west at an elevation of 45 degrees: 0 on level ground,
/// up to 0.3 on slopes towards the light, down to -1.7 on slopes away from it; 0 where the slope is unknown.
/// @param ground_msl_m  of the map's pixels; NaN: unknown; empty: all 0
std::vector<float> shadesOf(const MapGrid& grid, const std::vector<float>& ground_msl_m);

/// Pixels of the sea: level ground at mean sea level, wider than a pixel. 1 sea, 0 land or unknown.
std::vector<std::uint8_t> seaOf(const MapGrid& grid, const std::vector<float>& ground_msl_m);

/// Largest change of the lightness of a map's colours (OKLab, where black is 0 and white 1) by the relief.
constexpr double kMaxRelief = 0.07;

/// The colour of a value under a shade: hue and chroma are kept, the lightness differs by at most
/// kMaxRelief. Level ground has the colour itself.
render::Rgb shadedColor(const render::Rgb& color, float shade);

/// The colour of ground, or of the sea, without a value.
render::Rgb groundColor(float shade, bool is_sea);

}  // namespace emscape::study
