#include "study/picture/map_relief.h"

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

/// Height of a square; NaN beyond the edges.
float heightAt(const Relief& relief, int i, int j) {
  const bool is_inside = i >= 0 && i < relief.width && j >= 0 && j < relief.height;
  return is_inside ? relief.ground_msl_m[static_cast<std::size_t>(j) * relief.width + i] : NAN;
}

template <class Change>
void forSquares(const Relief& relief, const Change& change) {
  parallelFor(relief.height, 16, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < relief.width; ++i) change(i, j, static_cast<std::size_t>(j) * relief.width + i);
    }
  });
}

}  // namespace

std::vector<float> shadesOf(const Relief& relief) {
  std::vector<float> shades(relief.posts(), 0.0F);
  if (relief.ground_msl_m.empty()) return shades;
  const auto cell_m = static_cast<float>(relief.cell_m);
  forSquares(relief, [&](int i, int j, std::size_t p) {
    const float here = relief.ground_msl_m[p];
    const float east = slopeOf(heightAt(relief, i - 1, j), here, heightAt(relief, i + 1, j), cell_m);
    const float south = slopeOf(heightAt(relief, i, j - 1), here, heightAt(relief, i, j + 1), cell_m);
    const float toward = (0.5F * (east + south) + kLevel) / std::sqrt(1 + east * east + south * south);
    if (!std::isnan(toward)) shades[p] = toward - kLevel;
  });
  return shades;
}

void dropSmallWater(std::vector<std::uint8_t>& water, int width, int height, int smallest) {
  std::vector<std::uint8_t> is_done(water.size(), 0);
  std::vector<std::size_t> part;
  for (std::size_t start = 0; start < water.size(); ++start) {
    if (water[start] == 0 || is_done[start] != 0) continue;
    int left = width, right = -1, top = height, bottom = -1;
    part.assign(1, start);
    is_done[start] = 1;
    for (std::size_t n = 0; n < part.size(); ++n) {
      const int i = static_cast<int>(part[n] % width), j = static_cast<int>(part[n] / width);
      left = std::min(left, i);
      right = std::max(right, i);
      top = std::min(top, j);
      bottom = std::max(bottom, j);
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, height - 1); ++y) {
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, width - 1); ++x) {
          const std::size_t near = static_cast<std::size_t>(y) * width + x;
          if (water[near] == 0 || is_done[near] != 0) continue;
          is_done[near] = 1;
          part.push_back(near);
        }
      }
    }
    const bool is_small = right - left + 1 < smallest && bottom - top + 1 < smallest;
    const bool is_at_edge = left == 0 || top == 0 || right == width - 1 || bottom == height - 1;
    if (!is_small || is_at_edge) continue;
    for (const std::size_t p : part) water[p] = 0;
  }
}

render::Rgb shadedColor(const render::Rgb& color, float shade) {
  if (shade == 0) return color;
  constexpr double kSteepness = 3;  // of the change with small shades
  return render::withLightness(color, kMaxRelief * std::tanh(kSteepness * static_cast<double>(shade)));
}

render::Rgb drapedColor(const render::Rgb& color, const render::Rgb& picture) {
  constexpr double kMiddle = 0.7;  // lightness of usual charts and photographs
  return shadedColor(color, static_cast<float>(render::oklabOf(picture).lightness - kMiddle));
}

render::Rgb groundColor(float shade, bool is_sea) {
  if (is_sea) return {0.80F, 0.88F, 0.94F};
  constexpr double kLevelGround = 0.90, kDarkest = 0.55, kLightest = 0.97, kRelief = 0.55;
  const double lightness =
      std::clamp(kLevelGround + kRelief * static_cast<double>(shade), kDarkest, kLightest);
  return render::encoded(render::linearOf(render::Oklab{lightness, 0, 0}));
}

}  // namespace emscape::study
