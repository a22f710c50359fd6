#include "render/patterns/edges.h"

#include <algorithm>

#include "base/large_array.h"
#include "base/math/simd.h"
#include "emscape/base/parallel.h"

namespace emscape::render {
namespace {

constexpr int kBand = 16;  ///< rows that are processed together, and columns of a tile

EMSCAPE_SIMD_CLONES void quantizeAll(const float* from, std::size_t count, std::uint8_t* to) {
  for (std::size_t n = 0; n < count; ++n) to[n] = quantized(from[n]);
}

std::uint8_t difference(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>(a > b ? a - b : b - a);
}

/// contrast_levels() of a row. Beyond the picture's edge is the row itself.
/// @param largest  memory for the differences of all bytes
EMSCAPE_SIMD_CLONES void contrastsOfRow(const std::uint8_t* above, const std::uint8_t* here,
                                        const std::uint8_t* below, int width, std::uint8_t* largest,
                                        std::uint8_t* contrasts) {
  const int bytes = 4 * width;
  for (int n = 0; n < bytes; ++n)
    largest[n] = std::max(difference(here[n], above[n]), difference(here[n], below[n]));
  for (int n = 4; n < bytes; ++n) largest[n] = std::max(largest[n], difference(here[n], here[n - 4]));
  for (int n = 0; n + 4 < bytes; ++n) largest[n] = std::max(largest[n], difference(here[n], here[n + 4]));
  for (int x = 0; x < width; ++x) {
    contrasts[x] = std::max(std::max(largest[4 * x], largest[4 * x + 1]),
                            std::max(largest[4 * x + 2], largest[4 * x + 3]));
  }
}

}  // namespace

long long maxEdgePixels(ImageSize size) {
  return std::max(size.count() / 64, 4LL * (size.width + size.height));
}

int edgeContrast_levels(const ContrastCounts& counts, ImageSize size) {
  constexpr int kMinContrast = 12;
  const long long most = maxEdgePixels(size);
  long long pixels = 0;
  int contrast = 256;
  while (contrast > kMinContrast) {
    pixels += counts[static_cast<std::size_t>(contrast) - 1];
    if (pixels > most) break;
    --contrast;
  }
  return contrast;
}

std::vector<Pixel> edgePixels(const Image& picture) {
  const ImageSize size = picture.size;
  static_assert(sizeof(Rgba) == 4 * sizeof(float), "a pixel is four floats");
  const std::size_t width = static_cast<std::size_t>(size.width);
  std::vector<std::uint8_t> levels, contrasts;
  resizeInParts(levels, 4 * picture.pixels.size());
  resizeInParts(contrasts, picture.pixels.size());
  parallelFor(size.height, kBand, [&](int begin, int end) {
    const std::size_t first = begin * width;
    quantizeAll(&picture.pixels[first].r, 4 * (end * width - first), &levels[4 * first]);
  });
  const int bands = (size.height + kBand - 1) / kBand;
  std::vector<ContrastCounts> counts(static_cast<std::size_t>(bands), ContrastCounts{});
  parallelFor(bands, 1, [&](int begin, int end) {
    std::vector<std::uint8_t> largest(4 * width);
    for (int y = begin * kBand; y < std::min(end * kBand, size.height); ++y) {
      const auto row = [&](int at) { return &levels[4 * width * static_cast<std::size_t>(at)]; };
      std::uint8_t* const of_row = &contrasts[y * width];
      contrastsOfRow(row(std::max(y - 1, 0)), row(y), row(std::min(y + 1, size.height - 1)), size.width,
                     largest.data(), of_row);
      ContrastCounts& band = counts[static_cast<std::size_t>(y / kBand)];
      for (std::size_t x = 0; x < width; ++x) ++band[of_row[x]];
    }
  });
  ContrastCounts all{};
  for (const ContrastCounts& band : counts) {
    for (std::size_t n = 0; n < all.size(); ++n) all[n] += band[n];
  }
  const int least = edgeContrast_levels(all, size);
  std::vector<Pixel> edges;
  for (int band = 0; band < bands; ++band) {
    for (int left = 0; left < size.width; left += kBand) {
      for (int y = band * kBand; y < std::min((band + 1) * kBand, size.height); ++y) {
        for (int x = left; x < std::min(left + kBand, size.width); ++x) {
          if (contrasts[y * width + x] < least) continue;
          edges.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
        }
      }
    }
  }
  return edges;
}

}  // namespace emscape::render
