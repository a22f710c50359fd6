/// Assignment of pixels to threads, and conversions of colours. For .cu files.
#pragma once

#include "render/cast/rgba.h"
#include "render/patterns/reconstruction.h"

namespace emscape::render::cuda {

/// Threads of a block: they process a square of kTile x kTile pixels, a warp 8 x 4 of them, so that the rays
/// of a warp are close together.
constexpr int kTile = 16;
constexpr int kTileThreads = kTile * kTile;

/// Blocks for all pixels.
inline unsigned tileCount(ImageSize size) {
  return static_cast<unsigned>((size.width + kTile - 1) / kTile) *
         static_cast<unsigned>((size.height + kTile - 1) / kTile);
}

/// The pixel of this thread, in blocks whose squares are numbered row by row. @return false if there is none
__device__ inline bool pixelOfThread(ImageSize size, int& x, int& y) {
  const int tile_columns = (size.width + kTile - 1) / kTile;
  const int tile = static_cast<int>(blockIdx.x);
  const int warp = static_cast<int>(threadIdx.x) / 32;
  const int lane = static_cast<int>(threadIdx.x) % 32;
  x = tile % tile_columns * kTile + warp % 2 * 8 + lane % 8;
  y = tile / tile_columns * kTile + warp / 2 * 4 + lane / 8;
  return x < size.width && y < size.height;
}

__device__ inline long long pixelIndex(ImageSize size, int x, int y) {
  return static_cast<long long>(y) * size.width + x;
}

__device__ inline Rgba toRgba(const float4& p) {
  return {p.x, p.y, p.z, p.w};
}
__device__ inline float4 toFloat4(const Rgba& p) {
  return make_float4(p.r, p.g, p.b, p.a);
}

}  // namespace emscape::render::cuda
