/// How threads share out pixels. For .cu files.
#pragma once

#include "render/reconstruction.h"
#include "render/rgba.h"

namespace emscape::render::cuda {

/// Threads of a block; they take a square of kTile x kTile places, a warp 8 x 4 of them, so that the rays of
/// a warp lie close together.
constexpr int kTile = 16;
constexpr int kTileThreads = kTile * kTile;

inline unsigned tileCount(int columns, int rows) {
  return static_cast<unsigned>((columns + kTile - 1) / kTile) *
         static_cast<unsigned>((rows + kTile - 1) / kTile);
}

struct Place {
  int column = 0, row = 0;
};
/// The place of this thread among tiles that lie in rows.
__device__ inline Place placeOfThread(int columns) {
  const int tile_columns = (columns + kTile - 1) / kTile;
  const int tile = static_cast<int>(blockIdx.x);
  const int warp = static_cast<int>(threadIdx.x) / 32;
  const int lane = static_cast<int>(threadIdx.x) % 32;
  return {tile % tile_columns * kTile + warp % 2 * 8 + lane % 8,
          tile / tile_columns * kTile + warp / 2 * 4 + lane / 8};
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
