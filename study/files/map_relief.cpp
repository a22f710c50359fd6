#include "study/files/map_relief.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"
#include "render/transfer/oklab.h"

namespace emscape::study {
namespace {

constexpr float kLevel = 0.70710678F;  ///< cosine of the light's angle on level ground

/// Slope of three posts at distances of cell_m: central if all are known, one-sided at an edge, else NaN.
float slopeOf(float before, float here, float after, float cell_m) {
  if (std::isnan(before)) return (after - here) / cell_m;
  if (std::isnan(after)) return (here - before) / cell_m;
  return (after - before) / (2 * cell_m);
}

/// Values of a map's pixels; NaN beyond its edges.
class Posts {
 public:
  Posts(const MapGrid& grid, const std::vector<float>& values) : grid_(grid), values_(values) {}
  float at(int i, int j) const {
    const bool is_inside = i >= 0 && i < grid_.width && j >= 0 && j < grid_.height;
    return is_inside ? values_[static_cast<std::size_t>(j) * grid_.width + i] : NAN;
  }

 private:
  const MapGrid& grid_;
  const std::vector<float>& values_;
};

template <class Change>
void forPixels(const MapGrid& grid, const Change& change) {
  parallelFor(grid.height, 16, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < grid.width; ++i) change(i, j, static_cast<std::size_t>(j) * grid.width + i);
    }
  });
}

/// Whether a test holds of the 3 x 3 pixels around one, as far as they are on the map.
template <class Test>
bool allAround(const MapGrid& grid, int i, int j, const Test& test) {
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, grid.height - 1); ++y) {
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, grid.width - 1); ++x)
      if (!test(static_cast<std::size_t>(y) * grid.width + x)) return false;
  }
  return true;
}

}  // namespace

std::vector<float> shadesOf(const MapGrid& grid, const std::vector<float>& ground_msl_m) {
  std::vector<float> shades(grid.pixels(), 0.0F);
  if (ground_msl_m.empty()) return shades;
  const Posts ground(grid, ground_msl_m);
  const auto cell_m = static_cast<float>(grid.cell_m);
  forPixels(grid, [&](int i, int j, std::size_t p) {
    const float here = ground_msl_m[p];
    const float east = slopeOf(ground.at(i - 1, j), here, ground.at(i + 1, j), cell_m);
    const float south = slopeOf(ground.at(i, j - 1), here, ground.at(i, j + 1), cell_m);
    const float toward = (0.5F * (east + south) + kLevel) / std::sqrt(1 + east * east + south * south);
    if (!std::isnan(toward)) shades[p] = toward - kLevel;
  });
  return shades;
}

std::vector<std::uint8_t> seaOf(const MapGrid& grid, const std::vector<float>& ground_msl_m) {
  constexpr float kSea_m = 0.5F;
  std::vector<std::uint8_t> sea(grid.pixels(), 0);
  if (ground_msl_m.empty()) return sea;
  const auto isLevel = [&](std::size_t p) {
    return std::isnan(grid.positions[p].latitude_deg) || std::abs(ground_msl_m[p]) <= kSea_m;
  };
  std::vector<std::uint8_t> open(grid.pixels(), 0);  // sea on all sides
  forPixels(grid, [&](int i, int j, std::size_t p) {
    open[p] = std::abs(ground_msl_m[p]) <= kSea_m && allAround(grid, i, j, isLevel) ? 1 : 0;
  });
  forPixels(grid, [&](int i, int j, std::size_t p) {
    const bool is_near_open = !allAround(grid, i, j, [&](std::size_t near) { return open[near] == 0; });
    sea[p] = std::abs(ground_msl_m[p]) <= kSea_m && is_near_open ? 1 : 0;
  });
  return sea;
}

render::Rgb shadedColor(const render::Rgb& color, float shade) {
  if (shade == 0) return color;
  constexpr double kSteepness = 3;  // of the change with small shades
  return render::withLightness(color, kMaxRelief * std::tanh(kSteepness * static_cast<double>(shade)));
}

render::Rgb groundColor(float shade, bool is_sea) {
  if (is_sea) return {0.80F, 0.88F, 0.94F};
  constexpr double kLevelGround = 0.90, kDarkest = 0.55, kLightest = 0.97, kRelief = 0.55;
  const double lightness =
      std::clamp(kLevelGround + kRelief * static_cast<double>(shade), kDarkest, kLightest);
  return render::encoded(render::linearOf(render::Oklab{lightness, 0, 0}));
}

}  // namespace emscape::study
