#include "render/cpu/raycast_cpu.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/simd.h"

namespace emscape::render {
namespace {

/// Pixels of a lattice along a tile's side: small enough that neighbouring rays share what they read, and
/// that a stop is heeded soon.
constexpr int kTile = 16;

template <class Compositor, class Sampler>
EMSCAPE_SIMD_CLONES void castTile(const RaycastTask& task, const Lattice& lattice, int column, int row,
                                  Image& image) {
  const int columns_end = std::min(column + kTile, lattice.columns);
  const int rows_end = std::min(row + kTile, lattice.rows);
  for (int j = row; j < rows_end; ++j) {
    const int y = lattice.first_y + j * lattice.step_y;
    for (int i = column; i < columns_end; ++i) {
      const int x = lattice.first_x + i * lattice.step_x;
      image.at(x, y) = task.castPixel<Compositor, Sampler>(x, y);
    }
  }
}

using CastTile = void (*)(const RaycastTask&, const Lattice&, int, int, Image&);

template <class Sampler>
CastTile tileOf(CompositingMode mode) {
  switch (mode) {
    case CompositingMode::mida:
      return castTile<MidaCompositor, Sampler>;
    case CompositingMode::mip:
      return castTile<MipCompositor, Sampler>;
    case CompositingMode::dvr:
      break;
  }
  return castTile<DvrCompositor, Sampler>;
}

}  // namespace

bool castCpu(const RaycastTask& task, CompositingMode mode, bool nearest, const Lattice& lattice,
             Image& image, const StopFlag* stop) {
  const CastTile cast = nearest ? tileOf<NearestSampler>(mode) : tileOf<TrilinearSampler>(mode);
  const int tile_columns = (lattice.columns + kTile - 1) / kTile;
  const int tile_rows = (lattice.rows + kTile - 1) / kTile;
  const auto stopped = [stop] { return stop != nullptr && stop->load(std::memory_order_relaxed); };
  parallelFor(tile_columns * tile_rows, 1, [&](int begin, int end) {
    for (int tile = begin; tile < end && !stopped(); ++tile) {
      cast(task, lattice, tile % tile_columns * kTile, tile / tile_columns * kTile, image);
    }
  });
  return !stopped();
}

}  // namespace emscape::render
