#include "render/patterns/adaptive.h"

#include <algorithm>
#include <cstring>

#include "base/math/simd.h"
#include "emscape/base/parallel.h"
#include "render/patterns/adaptive_pass.h"

namespace emscape::render {
namespace {

/// Examined pixels along a tile's side: 16 pixels make one packet of rays.
constexpr int kTile = 4;
/// The same for a block, so that the rays of a pass, which may be few, are still neighbours.
constexpr int kBlock = 4 * kTile;

Pixel pixelAt(int x, int y) {
  return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
}

/// Class of an estimated error: 1 for less than 1/64 level, one more for every doubling.
std::uint8_t errorClassOf(float error_levels) {
  constexpr int kMinExponent = 127 - 6;
  std::int32_t bits = 0;
  static_assert(sizeof bits == sizeof error_levels, "float has 32 bits");
  std::memcpy(&bits, &error_levels, sizeof bits);
  const int error_class = (bits >> 23) - kMinExponent + 2;
  const int held = error_class > 1 ? error_class : 1;
  return static_cast<std::uint8_t>(held < kErrorClasses ? held : kErrorClasses - 1);
}

// --- A pixel as a vector ---

using Lanes = float __attribute__((vector_size(16)));

struct PixelLanes {
  Lanes lanes;
};
inline PixelLanes operator+(const PixelLanes& p, const PixelLanes& q) {
  return {p.lanes + q.lanes};
}
inline PixelLanes operator-(const PixelLanes& p, const PixelLanes& q) {
  return {p.lanes - q.lanes};
}
inline PixelLanes operator*(const PixelLanes& p, float s) {
  return {p.lanes * s};
}
inline PixelLanes addScaled(const PixelLanes& p, float s, const PixelLanes& q) {
  return p * s + q;
}
inline PixelLanes lesser(const PixelLanes& p, const PixelLanes& q) {
  return {p.lanes < q.lanes ? p.lanes : q.lanes};
}
inline PixelLanes greater(const PixelLanes& p, const PixelLanes& q) {
  return {p.lanes > q.lanes ? p.lanes : q.lanes};
}
inline PixelLanes magnitude(const PixelLanes& p) {
  return greater(p, PixelLanes{} - p);
}
inline float largestChannel(const PixelLanes& p) {
  const PixelLanes pairs = greater(p, {__builtin_shufflevector(p.lanes, p.lanes, 2, 3, 2, 3)});
  return std::max(pairs.lanes[0], pairs.lanes[1]);
}

}  // namespace

template <>
inline PixelLanes uniform<PixelLanes>(float value) {
  return {Lanes{value, value, value, value}};
}

namespace {

/// Access to the picture for the prediction of midpoints.
struct KnownPixels {
  using Color = PixelLanes;

  Rgba* pixels = nullptr;
  ImageSize size;

  Rgba* address(int x, int y) const { return pixels + static_cast<std::ptrdiff_t>(y) * size.width + x; }
  PixelLanes at(int x, int y) const { return load(address(x, y)); }
  static PixelLanes load(const Rgba* pixel) {
    PixelLanes color;
    std::memcpy(&color, pixel, sizeof color);
    return color;
  }
  static void store(const PixelLanes& color, Rgba* pixel) {
    std::memcpy(static_cast<void*>(pixel), &color, sizeof color);
  }

  /// Prediction along the direction in which the next known pixels are `step` further in memory.
  static Along<PixelLanes> along(const Rgba* middle, std::ptrdiff_t step) {
    return predictAlong(load(middle - step), load(middle + step), load(middle - 3 * step),
                        load(middle + 3 * step));
  }
};

/// Inputs of one pass.
struct PassTask {
  Pass pass;
  KnownPixels known;
  const Silhouette& inside;
  float tolerance_levels;
  std::uint8_t* classes;
};

/// One row of a tile: midpoints first_x, first_x + pass.stepX(), ... below end_x.
inline void predictRow(const PassTask& task, int first_x, int end_x, int y, std::vector<Pixel>& queue) {
  // Copies, because the bytes written below might alias any part of the task.
  const KnownPixels known = task.known;
  const int reach = task.pass.reach;
  const int step_x = task.pass.stepX();
  const float tolerance_levels = task.tolerance_levels;
  const std::ptrdiff_t width = known.size.width;
  const std::ptrdiff_t step_p = task.pass.diagonal ? reach * (width + 1) : reach;
  const std::ptrdiff_t step_q = task.pass.diagonal ? reach * (width - 1) : reach * width;
  const bool rows_known = y >= 3 * reach && y + 3 * reach < known.size.height;
  const int first_known = rows_known ? 3 * reach : known.size.width;
  const int end_known = known.size.width - 3 * reach;
  Rgba* const pixels = known.address(0, y);
  std::uint8_t* const classes = task.classes + static_cast<std::ptrdiff_t>(y) * width;
  for (int x = first_x; x < end_x; x += step_x) {
    Prediction<PixelLanes> prediction;
    bool predicted = true;
    if (x >= first_known && x < end_known) {
      prediction = predict(KnownPixels::along(pixels + x, step_p), KnownPixels::along(pixels + x, step_q));
    } else {
      predicted = predictMidpoint(known, task.pass, x, y, prediction);
    }
    if (predicted && prediction.error_levels <= tolerance_levels) {
      KnownPixels::store(prediction.color, pixels + x);
      classes[x] = errorClassOf(prediction.error_levels);
    } else {
      classes[x] = 0;
      queue.push_back(pixelAt(x, y));
    }
  }
}

/// Visits a row of blocks of pixels (0, first_y), (step_x, first_y), ...: block by block, tile by tile, row
/// by row of each tile.
/// @param visit  receives a row's first pixel
template <class Visit>
inline void visitTiles(ImageSize size, int step_x, int step_y, int first_y, const Visit& visit) {
  const int end_y = std::min(first_y + kBlock * step_y, size.height);
  for (int block_x = 0; block_x < size.width; block_x += kBlock * step_x) {
    const int end_x = std::min(block_x + kBlock * step_x, size.width);
    for (int tile_y = first_y; tile_y < end_y; tile_y += kTile * step_y) {
      for (int tile_x = block_x; tile_x < end_x; tile_x += kTile * step_x) {
        for (int y = tile_y; y < std::min(tile_y + kTile * step_y, end_y); y += step_y) visit(tile_x, y);
      }
    }
  }
}

/// A row of blocks of a pass.
EMSCAPE_SIMD_CLONES void predictBlocks(const PassTask& task, int first_y, std::vector<Pixel>& queue) {
  const int step_x = task.pass.stepX();
  visitTiles(task.known.size, step_x, task.pass.stepY(), first_y, [&](int tile_x, int y) {
    const Span& row = task.inside.rows[static_cast<std::size_t>(y)];
    const int tile_end_x = tile_x + kTile * step_x;
    if (tile_end_x <= row.begin || tile_x >= row.end) return;
    int first_x = tile_x + task.pass.firstX(y);
    while (first_x < row.begin) first_x += step_x;
    predictRow(task, first_x, std::min(tile_end_x, row.end), y, queue);
  });
}

/// A row of blocks of the lattice.
void queueLattice(ImageSize size, const Silhouette& inside, int first_y, std::vector<Pixel>& queue) {
  visitTiles(size, kLatticeStep, kLatticeStep, first_y, [&](int tile_x, int y) {
    const Span& row = inside.rows[static_cast<std::size_t>(y)];
    const int end_x = std::min(tile_x + kTile * kLatticeStep, row.end);
    for (int x = tile_x; x < end_x; x += kLatticeStep) {
      if (x >= row.begin) queue.push_back(pixelAt(x, y));
    }
  });
}

}  // namespace

bool AdaptiveFrame::draw(Image& image, const Silhouette& inside, double tolerance_levels, double max_rays,
                         const Caster& cast) {
  const double held_levels = hold_.levels(tolerance_levels);
  double rays = 0;
  size_ = image.size;
  classes_.resize(image.pixels.size());
  clear(image, inside);
  const auto castQueued = [&] {
    joinQueues();
    rays += static_cast<double>(queue_.size());
    return queue_.empty() || cast(queue_);
  };
  queueRows(kBlock * kLatticeStep,
            [&](int first_y, std::vector<Pixel>& queue) { queueLattice(size_, inside, first_y, queue); });
  if (!castQueued()) return false;
  for (const Pass& pass : kPasses) {
    const PassTask task{pass,
                        {image.pixels.data(), size_},
                        inside,
                        static_cast<float>(held_levels * pass.tolerance),
                        classes_.data()};
    queueRows(kBlock * pass.stepY(), [&](int first_y, std::vector<Pixel>& queue) {
      predictBlocks(task, first_y + pass.firstY(), queue);
    });
    if (!castQueued()) return false;
  }
  hold_.drawn(held_levels, rays, max_rays);
  return true;
}

const std::vector<Pixel>& AdaptiveFrame::missing() {
  const int rows = (size_.height + kBlock - 1) / kBlock;
  const auto forEachMissing = [this](int block_row, const auto& visit) {
    visitTiles(size_, 1, 1, block_row * kBlock, [&](int tile_x, int y) {
      const std::uint8_t* classes = &classes_[static_cast<std::size_t>(y) * size_.width];
      for (int x = tile_x; x < std::min(tile_x + kTile, size_.width); ++x) {
        if (classes[x] != 0) visit(x, y, classes[x]);
      }
    });
  };
  // A counting sort: number of pixels of each class in each row of blocks, then the beginning of each.
  places_.assign(static_cast<std::size_t>(rows), {});
  parallelFor(rows, 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      auto& counts = places_[static_cast<std::size_t>(row)];
      forEachMissing(row,
                     [&](int, int, int error_class) { ++counts[static_cast<std::size_t>(error_class)]; });
    }
  });
  std::uint32_t total = 0;
  for (std::size_t error_class = kErrorClasses - 1; error_class > 0; --error_class) {
    for (auto& places : places_) {
      const std::uint32_t count = places[error_class];
      places[error_class] = total;
      total += count;
    }
  }
  missing_.resize(total);
  parallelFor(rows, 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      auto& places = places_[static_cast<std::size_t>(row)];
      forEachMissing(row, [&](int x, int y, int error_class) {
        missing_[places[static_cast<std::size_t>(error_class)]++] = pixelAt(x, y);
      });
    }
  });
  return missing_;
}

void AdaptiveFrame::clear(Image& image, const Silhouette& inside) {
  constexpr int kRowGrain = 32;
  parallelFor(size_.height, kRowGrain, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const Span& row = inside.rows[static_cast<std::size_t>(y)];
      Rgba* pixels = image.pixels.data() + static_cast<std::size_t>(y) * size_.width;
      std::fill(pixels, pixels + row.begin, Rgba{});
      std::fill(pixels + row.end, pixels + size_.width, Rgba{});
      std::uint8_t* classes = classes_.data() + static_cast<std::size_t>(y) * size_.width;
      std::fill(classes, classes + size_.width, std::uint8_t{0});
    }
  });
}

void AdaptiveFrame::queueRows(int block_height, const RowQueuer& row) {
  const int rows = (size_.height + block_height - 1) / block_height;
  if (queues_.size() < static_cast<std::size_t>(rows)) queues_.resize(static_cast<std::size_t>(rows));
  for (std::vector<Pixel>& queue : queues_) queue.clear();
  parallelFor(rows, 1, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) row(r * block_height, queues_[static_cast<std::size_t>(r)]);
  });
}

void AdaptiveFrame::joinQueues() {
  queue_.clear();
  for (const std::vector<Pixel>& queue : queues_) queue_.insert(queue_.end(), queue.begin(), queue.end());
}

}  // namespace emscape::render
