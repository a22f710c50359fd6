#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"
#include "render/interpolation.h"

namespace emscape::render::cuda {
namespace {

struct FloatPixels {
  float4* pixels;
  __device__ void put(long long index, const Rgba& color) const { pixels[index] = toFloat4(color); }
};
struct Pixels8 {
  uchar4* pixels;
  __device__ void put(long long index, const Rgba& color) const {
    pixels[index] =
        make_uchar4(quantized(color.r), quantized(color.g), quantized(color.b), quantized(color.a));
  }
};

template <class Arithmetic, class Target>
__global__ void __launch_bounds__(kTileThreads) fillPicture(Layers layers, Target target) {
  const ImageSize size = layers.size;
  const Place place = placeOfThread(size.width);
  if (place.column >= size.width || place.row >= size.height) return;
  const auto source = [&](int x, int y) { return toRgba(layers.volume[pixelIndex(size, x, y)]); };
  Rgba color = pixelOf<Arithmetic>(layers.pattern, source, size, place.column, place.row);
  const long long index = pixelIndex(size, place.column, place.row);
  if (layers.ground_distances != nullptr && layers.ground_distances[index] < INFINITY) {
    color = over(color, toRgba(layers.ground_colors[index]));
  }
  target.put(index, color);
}

template <class Target>
void show(const Layers& layers, const Target& target, cudaStream_t stream) {
  const unsigned blocks = tileCount(layers.size.width, layers.size.height);
  if (blocks == 0) return;
  if (layers.interpolation == Interpolation::float32) {
    fillPicture<FloatArithmetic><<<blocks, kTileThreads, 0, stream>>>(layers, target);
  } else {
    fillPicture<Bits8Arithmetic><<<blocks, kTileThreads, 0, stream>>>(layers, target);
  }
  emscape::cuda::checkLaunch("fillPicture");
}

}  // namespace

void showPicture(const Layers& layers, float4* picture, cudaStream_t stream) {
  show(layers, FloatPixels{picture}, stream);
}
void showPicture8(const Layers& layers, uchar4* picture, cudaStream_t stream) {
  show(layers, Pixels8{picture}, stream);
}

}  // namespace emscape::render::cuda
