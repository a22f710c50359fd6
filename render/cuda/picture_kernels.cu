#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"
#include "render/patterns/interpolation.h"

namespace emscape::render::cuda {
namespace {

/// Cells of a block: a thread makes a cell of 2 x 2 pixels.
constexpr unsigned kCellColumns = 32, kCellRows = 8;

/// Two pixels of a row, which are written together.
template <class Pixel>
struct alignas(2 * sizeof(Pixel)) PixelPair {
  Pixel left, right;
};

/// @param Pixel  of the picture: Rgba or Rgba8
template <class Arithmetic, bool kHasGround, class Pixel>
__global__ void __launch_bounds__(kCellColumns* kCellRows)
    fillPicture(const __grid_constant__ Layers layers, Pixel* picture) {
  const ImageSize size = layers.size;
  const int x = 2 * static_cast<int>(blockIdx.x * kCellColumns + threadIdx.x);
  const int y = 2 * static_cast<int>(blockIdx.y * kCellRows + threadIdx.y);
  if (x >= size.width || y >= size.height) return;
  const auto indexOf = [&](int px, int py) {
    return static_cast<unsigned>(py) * static_cast<unsigned>(size.width) + static_cast<unsigned>(px);
  };

  Rgba ground[2][2];  // transparent if there is none
  if constexpr (kHasGround) {
    unsigned indices[4];
    float distances[4];  // loaded together, to wait only once
    EMSCAPE_UNROLL
    for (int n = 0; n < 4; ++n) {
      indices[n] = indexOf(min(x + n % 2, size.width - 1), min(y + n / 2, size.height - 1));
      distances[n] = layers.ground_distances[indices[n]];
    }
    EMSCAPE_UNROLL
    for (int n = 0; n < 4; ++n) {
      if (distances[n] < INFINITY) ground[n / 2][n % 2] = toRgba(layers.ground_colors[indices[n]]);
    }
  }
  PixelPair<Pixel> rows[2];
  const auto source = [&](int px, int py) { return toRgba(layers.volume.at(px, py)); };
  const auto toPixel = [](const auto& color) {
    if constexpr (std::is_same_v<Pixel, Rgba8>) {
      return quantized(color);
    } else {
      return toRgba(color);
    }
  };
  const auto put = [&](int column, int row, const auto& color) {
    Pixel& pixel = column == 0 ? rows[row].left : rows[row].right;
    if constexpr (kHasGround) {
      pixel = toPixel(over(toRgba(color), ground[row][column]));
    } else {
      pixel = toPixel(color);
    }
  };
  fillCell<Arithmetic>(layers.pattern, size, x, y, source, put);

  EMSCAPE_UNROLL
  for (int row = 0; row < 2; ++row) {
    if (y + row >= size.height) return;
    Pixel* to = picture + indexOf(x, y + row);
    if (size.width % 2 == 0) {
      *reinterpret_cast<PixelPair<Pixel>*>(to) = rows[row];
    } else {
      to[0] = rows[row].left;
      if (x + 1 < size.width) to[1] = rows[row].right;
    }
  }
}

template <class Arithmetic, class Pixel>
auto kernelFor(const Layers& layers) {
  return layers.ground_distances != nullptr ? fillPicture<Arithmetic, true, Pixel>
                                            : fillPicture<Arithmetic, false, Pixel>;
}

template <class Pixel>
void show(const Layers& layers, Pixel* picture, cudaStream_t stream) {
  if (layers.size.count() == 0) return;
  const auto blocks = [](int pixels, unsigned cells) {
    return (static_cast<unsigned>(pixels) + 2 * cells - 1) / (2 * cells);
  };
  const dim3 grid(blocks(layers.size.width, kCellColumns), blocks(layers.size.height, kCellRows));
  const auto kernel = layers.interpolation == Interpolation::float32
                          ? kernelFor<FloatArithmetic, Pixel>(layers)
                          : kernelFor<Bits8Arithmetic, Pixel>(layers);
  kernel<<<grid, dim3(kCellColumns, kCellRows), 0, stream>>>(layers, picture);
  emscape::cuda::checkLaunch("fillPicture");
}

}  // namespace

void showPicture(const Layers& layers, float4* picture, cudaStream_t stream) {
  show(layers, reinterpret_cast<Rgba*>(picture), stream);
}
void showPicture8(const Layers& layers, uchar4* picture, cudaStream_t stream) {
  show(layers, reinterpret_cast<Rgba8*>(picture), stream);
}

}  // namespace emscape::render::cuda
