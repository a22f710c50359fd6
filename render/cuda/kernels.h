/// The ray caster's kernels as the host starts them. All pointers are to device memory.
/// @throws Error (device) that names the kernel
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <iterator>

#include "render/adaptive_pass.h"
#include "render/compositing.h"
#include "render/cuda/submission.h"
#include "render/raycast.h"
#include "render/reconstruction.h"
#include "render/silhouette.h"
#include "render/skip_rule.h"
#include "volume/bricks.h"

namespace emscape::render::cuda {

/// The volume alone as it is cast: a colour for each pixel of the picture. Pixels whose x is even or odd, and
/// y, lie apart in four planes: so the source pixels of a pattern lie together.
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

/// Which pixels a launch casts: those of a lattice, or a part of a list.
struct PixelSet {
  Lattice lattice;
  const Pixel* list = nullptr;  ///< null: the lattice
  unsigned first = 0;           ///< of the list
  unsigned end = 0;             ///< of the list, one beyond the last
};

enum class Sampling {
  filtered,  ///< by the texture unit, with fractions of 8 bits
  accurate,  ///< as on the CPU, by eight texels
  nearest,
  sparse,  ///< as on the CPU, by eight voxels of a NanoVDB grid
  sparse_nearest
};

/// A transfer function's colours as the kernels that filter hold them in shared memory: r g, b a as halves.
struct HalfColor {
  std::uint32_t rg = 0, ba = 0;
};
/// Entries that fit.
constexpr int kMostHalfColors = 4096;

/// In which order the tasks of a lattice are cast: see OrderFinder. Right for any view of that lattice, and
/// fast for those close to the one it was found for.
struct alignas(16) TaskOrder {
  static constexpr int kAlong = 38;  ///< cells, in either direction
  static constexpr unsigned kCells = kAlong * kAlong;

  /// What it is an order of.
  struct Shape {
    int columns = 0, rows = 0;  ///< of the lattice; 0: of nothing
    int tile_width = 0;         ///< pixels
    unsigned warps = 0;         ///< of the launch
    bool has_halves = false;    ///< rays may be cast in halves

    EMSCAPE_HD bool operator==(const Shape& other) const {
      return columns == other.columns && rows == other.rows && tile_width == other.tile_width &&
             warps == other.warps && has_halves == other.has_halves;
    }
  };
  Shape shape;
  unsigned shown = 0, all = 0;              ///< tiles, or halves of them, that show something; all of them
  unsigned carriers = 0, carried = 0;       ///< numbers that carry others, and how many each
  unsigned short entries[2 * kCells] = {};  ///< cell * kPortions + portion; see Portion
};

struct CastLaunch {
  RaycastTask task;  ///< volume_highest_f does not count
  PixelSet pixels;
  const HalfColor* half_colors = nullptr;   ///< of task.transfer.samples; for Sampling::filtered
  const float* volume_highest_f = nullptr;  ///< one
  const float* limits = nullptr;            ///< one a pixel: where the ground is, or a section; null: nowhere
  const float* begins = nullptr;            ///< one a pixel: where planes let its ray begin; null: not cut
  unsigned* next_tile = nullptr;            ///< 0, before each launch and after it; one a stream
  const TaskOrder* order = nullptr;         ///< an earlier launch found it, or all 0; null: there is none
  TaskOrder* next_order = nullptr;          ///< another, that receives the one for this view; null with order
  Layer layer;
};
void castPixels(const CastLaunch& launch, CompositingMode mode, Sampling sampling, const Submission& to);
/// The same for a sparse sampling alone.
void castSparse(const CastLaunch& launch, CompositingMode mode, Sampling sampling, const Submission& to);

/// Where every pixel's ray meets the ground (infinity: nowhere), and its colour there.
void castGround(const RaycastTask& task, float* distances, float4* colors, cudaStream_t stream);

/// What planes leave of every pixel's ray; arrays of one a pixel.
struct CutLayer {
  const float* ground_distances = nullptr;  ///< null: no ground
  const float4* ground_colors = nullptr;
  float* begins = nullptr;     ///< of the samples
  float* limits = nullptr;     ///< of the samples
  float* distances = nullptr;  ///< of the section or the ground that is seen; infinity: of none
  float4* colors = nullptr;    ///< of it
};
/// @param task  its texture does not filter
void castCut(const RaycastTask& task, Sampling sampling, const CutLayer& layer, cudaStream_t stream);

// --- The picture ---

/// The volume's layer and what lies behind it, the ground or a section.
struct Layers {
  ImageSize size;
  Pattern pattern = Pattern::full;  ///< of the layer: which of its pixels count; adaptive: all
  Interpolation interpolation = Interpolation::float32;
  Layer volume;
  const float* ground_distances = nullptr;  ///< null: no ground
  const float4* ground_colors = nullptr;
};
void showPicture(const Layers& layers, float4* picture, const Submission& to);
void showPicture8(const Layers& layers, uchar4* picture, const Submission& to);

/// A cast picture between the layers of its labels, pixel by pixel.
/// @param count          pixels
/// @param cast, picture  bytes r g b a; the picture is opaque where `behind` is
/// @param behind, front  0xAARRGGBB, premultiplied
void composeOverlay(unsigned count, const std::uint32_t* behind, const uchar4* cast,
                    const std::uint32_t* front, uchar4* picture, cudaStream_t stream);

// --- Adaptive ---

/// A frame: what is cast, its `pixels` aside, and what decides which pixels are.
struct AdaptiveLaunch : CastLaunch {
  static constexpr int kPassCount = static_cast<int>(std::size(kPasses));
  const Span* inside = nullptr;  ///< one a row
  float tolerance_levels = 0;
  std::uint8_t* classes =
      nullptr;               ///< receives those of the estimated error, one a pixel; see errorClassOf()
  unsigned* rays = nullptr;  ///< is increased by the number of rays cast
};
/// Casts the frame and predicts what it does not cast; the whole layer is written.
void castAdaptive(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling,
                  const Submission& to);
/// The same for a sparse sampling alone.
void castSparse(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, const Submission& to);

/// Counters for listPredicted(): how many pixels there are of each class, and how many are placed.
struct ClassCounts {
  unsigned found[kErrorClasses];
  unsigned placed[kErrorClasses];
};
/// Lists the pixels that were predicted, those of the highest class first. @param counts  all 0
void listPredicted(const std::uint8_t* classes, ImageSize size, ClassCounts* counts, Pixel* list,
                   cudaStream_t stream);

// --- Bricks ---

/// What the bricks of a volume come to.
struct BrickSummary {
  float highest_f = 0;     ///< the largest f of all
  unsigned skippable = 0;  ///< how many have a level below SkipView::kNever
};
/// SkipView's entries of all bricks. @param rule  pointers to device memory; summary  all 0
void findLevels(const SkipRule& rule, const volume::BricksView& bricks, float* highest, float* levels,
                BrickSummary* summary, cudaStream_t stream);

}  // namespace emscape::render::cuda
