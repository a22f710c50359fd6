/// Launches of the ray caster's kernels. All pointers are to device memory.
/// @throws Error (device) that names the kernel
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <iterator>

#include "render/cast/compositing.h"
#include "render/cast/raycast.h"
#include "render/cast/skip_rule.h"
#include "render/patterns/adaptive_pass.h"
#include "render/patterns/reconstruction.h"
#include "render/scene/silhouette.h"
#include "volume/bricks.h"

namespace emscape::render::cuda {

/// The cast volume without ground: a colour per pixel of the picture, in four planes by odd and even x and y,
/// so that the source pixels of a pattern are contiguous.
struct Layer {
  float4* pixels = nullptr;
  ImageSize size;

  EMSCAPE_HD int columns() const { return (size.width + 1) / 2; }
  EMSCAPE_HD int rows() const { return (size.height + 1) / 2; }
  EMSCAPE_HD std::size_t length() const { return 4 * static_cast<std::size_t>(columns()) * rows(); }
  EMSCAPE_HD float4& at(int x, int y) const {
    const int row = (y % 2 * 2 + x % 2) * rows() + y / 2;
    return pixels[static_cast<std::size_t>(row) * columns() + x / 2];
  }
};

// --- Casting ---

/// The pixels of a lattice in tiles of 32, nearly square in the picture: a warp casts one at a time.
struct LatticeTiles {
  Lattice lattice;

  EMSCAPE_HD unsigned count() const {
    return across() * ((static_cast<unsigned>(lattice.rows) - 1) / (32 / width()) + 1);
  }
  /// @param lane  0..31
  /// @return false: there is no such pixel
  EMSCAPE_HD bool pixelOf(unsigned tile, unsigned lane, Pixel& pixel) const {
    const auto column = static_cast<int>(tile % across() * width() + lane % width());
    const auto row = static_cast<int>(tile / across() * (32 / width()) + lane / width());
    pixel = {static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
             static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
    return column < lattice.columns && row < lattice.rows;
  }

 private:
  EMSCAPE_HD unsigned width() const { return lattice.step_x > lattice.step_y ? 4 : 8; }
  EMSCAPE_HD unsigned across() const { return (static_cast<unsigned>(lattice.columns) - 1) / width() + 1; }
};

enum class Sampling {
  filtered,  ///< by the texture unit, with fractions of 8 bits
  accurate,  ///< as on the CPU, by eight texels
  nearest,
  sparse,  ///< as filtered, by the tiles of a sparse volume
  sparse_accurate,
  sparse_nearest
};
constexpr bool isFiltered(Sampling sampling) {
  return sampling == Sampling::filtered || sampling == Sampling::sparse;
}

/// A colour of the transfer function's table in shared memory: r g, b a as halves.
struct HalfColor {
  std::uint32_t rg = 0, ba = 0;
};
/// Entries that fit into shared memory.
constexpr int kMaxHalfColors = 4096;

struct CastLaunch {
  RaycastTask task;  ///< without volume_highest_f
  LatticeTiles tiles;
  const HalfColor* half_colors = nullptr;   ///< of task.transfer.samples; for isFiltered()
  const float* volume_highest_f = nullptr;  ///< one
  const float* limits = nullptr;  ///< one per pixel: distance of the ground or a section; null: none
  const float* begins = nullptr;  ///< one per pixel: beginning of its ray at planes; null: not cut
  /// One per pixel: false if it is not cast; null: all are cast.
  const bool* predicted = nullptr;
  unsigned* next_tile = nullptr;  ///< queue counter: zero between launches; one per stream
  Layer layer;
};
void castPixels(const CastLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream);
/// The same, only for a sparse sampling.
void castSparse(const CastLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream);

/// Distance at which every pixel's ray meets the ground (infinity: none), the colour there, and whether it is
/// the ground's surface.
/// @param only  one per pixel: false if it is left out; null: none is. As in castMap() and castCut()
void castGround(const RaycastTask& task, const bool* only, float* distances, float4* colors, bool* is_surface,
                cudaStream_t stream);

/// The ground with the map layer; arrays with one element per pixel.
struct MapLayer {
  const float* distances = nullptr;  ///< as of castGround(), as the next two
  const float4* colors = nullptr;
  const bool* is_surface = nullptr;
  float4* mapped = nullptr;  ///< receives the colours of hits
};
/// @param task  its texture does not filter
void castMap(const RaycastTask& task, Sampling sampling, const bool* only, const MapLayer& layer,
             cudaStream_t stream);

/// The part of every pixel's ray that planes keep; arrays with one element per pixel.
struct CutLayer {
  const float* ground_distances = nullptr;  ///< null: no ground
  const float4* ground_colors = nullptr;
  float* begins = nullptr;     ///< of the samples
  float* limits = nullptr;     ///< of the samples
  float* distances = nullptr;  ///< of the visible section or ground; infinity: none
  float4* colors = nullptr;    ///< of it
};
/// @param task  its texture does not filter
void castCut(const RaycastTask& task, Sampling sampling, const bool* only, const CutLayer& layer,
             cudaStream_t stream);

// --- The picture ---

/// The volume's layer, and the ground or a section behind it.
struct Layers {
  ImageSize size;
  Pattern pattern = Pattern::full;  ///< selects the valid pixels of the layer; adaptive: all
  Interpolation interpolation = Interpolation::float32;
  Layer volume;
  const float* ground_distances = nullptr;  ///< null: no ground
  const float4* ground_colors = nullptr;
};
void showPicture(const Layers& layers, float4* picture, cudaStream_t stream);
void showPicture8(const Layers& layers, uchar4* picture, cudaStream_t stream);

// Edges of a picture; see render/patterns/edges.h. Arrays have one element per pixel.

/// @param counts  is increased: 256 numbers of pixels
void findContrasts(ImageSize size, const uchar4* picture, std::uint8_t* contrasts, unsigned* counts,
                   cudaStream_t stream);
/// The pixels of at least a contrast.
void markEdges(ImageSize size, const std::uint8_t* contrasts, int least, bool* is_edge, cudaStream_t stream);
/// Adds one of kEdgeRays pictures to the means of the pixels at edges; the first one begins them.
void addEdgeRay(const Layers& layers, const bool* is_edge, bool is_first, float4* means, cudaStream_t stream);
/// Puts the means into a picture; either may be null.
void putEdges(ImageSize size, const bool* is_edge, const float4* means, float4* picture, uchar4* picture8,
              cudaStream_t stream);

/// A cast picture between the layers of its labels, pixel by pixel.
/// @param count          pixels
/// @param cast, picture  bytes r g b a; the picture is opaque where `behind` is
/// @param behind, front  0xAARRGGBB, premultiplied
void composeOverlay(unsigned count, const std::uint32_t* behind, const uchar4* cast,
                    const std::uint32_t* front, uchar4* picture, cudaStream_t stream);

// --- Adaptive ---

/// An adaptive frame: inputs of the cast, except `tiles` and `predicted`, and the criteria that select
/// pixels.
struct AdaptiveLaunch : CastLaunch {
  static constexpr int kPassCount = static_cast<int>(std::size(kPasses));
  Pass passes[kPassCount] = {kPasses[0], kPasses[1], kPasses[2], kPasses[3]};
  const Span* inside = nullptr;  ///< one per row
  float tolerance_levels = 0;
  bool* is_predicted = nullptr;  ///< receives one per pixel
  unsigned* rays = nullptr;      ///< is increased by the number of rays cast
};
static_assert(sizeof(AdaptiveLaunch) <= 4096, "what a kernel's parameters may take");
/// Casts the frame and predicts the other pixels; the whole layer is written.
void castAdaptive(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream);
/// The same, only for a sparse sampling.
void castSparse(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream);

// --- Bricks ---

/// Summary of a volume's bricks.
struct BrickSummary {
  float highest_f = 0;     ///< the largest f of all
  unsigned skippable = 0;  ///< number of bricks with a level below SkipView::kNever
};
/// SkipView's entries of all bricks. @param rule  pointers to device memory; summary  all 0
void findLevels(const SkipRule& rule, const volume::BricksView& bricks, float* highest, float* levels,
                BrickSummary* summary, cudaStream_t stream);

}  // namespace emscape::render::cuda
