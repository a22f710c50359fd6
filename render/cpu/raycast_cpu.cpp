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

template <class Compositor, class Sampler>
EMSCAPE_SIMD_CLONES void castList(const RaycastTask& task, const Pixel* pixels, int count, Image& image) {
  for (int n = 0; n < count; ++n) {
    const int x = pixels[n].x;
    const int y = pixels[n].y;
    image.at(x, y) = task.castPixel<Compositor, Sampler>(x, y);
  }
}

/// The loops for one kind of compositing and sampling.
struct Loops {
  void (*tile)(const RaycastTask&, const Lattice&, int, int, Image&);
  void (*list)(const RaycastTask&, const Pixel*, int, Image&);
};

template <class Compositor, class Sampler>
constexpr Loops kLoops{castTile<Compositor, Sampler>, castList<Compositor, Sampler>};

template <class Sampler>
Loops loopsOf(CompositingMode mode) {
  switch (mode) {
    case CompositingMode::mida:
      return kLoops<MidaCompositor, Sampler>;
    case CompositingMode::mip:
      return kLoops<MipCompositor, Sampler>;
    case CompositingMode::dvr:
      break;
  }
  return kLoops<DvrCompositor, Sampler>;
}

Loops loopsOf(CompositingMode mode, bool nearest) {
  return nearest ? loopsOf<NearestSampler>(mode) : loopsOf<TrilinearSampler>(mode);
}

bool isSet(const StopFlag* stop) {
  return stop != nullptr && stop->load(std::memory_order_relaxed);
}

}  // namespace

bool castCpu(const RaycastTask& task, CompositingMode mode, bool nearest, const Lattice& lattice,
             Image& image, const StopFlag* stop) {
  const Loops loops = loopsOf(mode, nearest);
  const int tile_columns = (lattice.columns + kTile - 1) / kTile;
  const int tile_rows = (lattice.rows + kTile - 1) / kTile;
  parallelFor(tile_columns * tile_rows, 1, [&](int begin, int end) {
    for (int tile = begin; tile < end && !isSet(stop); ++tile) {
      loops.tile(task, lattice, tile % tile_columns * kTile, tile / tile_columns * kTile, image);
    }
  });
  return !isSet(stop);
}

bool castCpu(const RaycastTask& task, CompositingMode mode, bool nearest, const std::vector<Pixel>& pixels,
             Image& image, const StopFlag* stop) {
  const Loops loops = loopsOf(mode, nearest);
  constexpr int kPiece = kTile * kTile;
  const int count = static_cast<int>(pixels.size());
  parallelFor((count + kPiece - 1) / kPiece, 1, [&](int begin, int end) {
    for (int piece = begin; piece < end && !isSet(stop); ++piece) {
      const int first = piece * kPiece;
      loops.list(task, &pixels[static_cast<std::size_t>(first)], std::min(kPiece, count - first), image);
    }
  });
  return !isSet(stop);
}

}  // namespace emscape::render
