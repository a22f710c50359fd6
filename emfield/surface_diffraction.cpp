#include "emfield/surface_diffraction.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"
#include "emfield/read_posts.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using propagation::DiffractionModel;

constexpr int kBlock = SurfaceDiffraction::kBlock;
constexpr int kMaxChords = 8;  // longer paths are left to the full read
/// Arrays of Memory::per_block.
enum BlockNumber { kColumn, kRow, kLowered, kTxBound, kBound, kBlockNumbers };

/// What all paths share.
struct Paths {
  DiffractionModel<float> model;
  const double* range_m;    ///< of the posts
  const float* obstacle_m;  ///< the same
  const double* begin_m;    ///< per block: range of its first post
  const float* first_m;     ///< per block: range of its first and last obstacle
  const float* last_m;
  const float* first_bulge_m;  ///< per block: the earth's bulge r^2 / (2 a) at its first obstacle
  const float* window_msl_m;   ///< TerrainBounds
  int row_windows;
};

/// The path to a column. Heights are relative to the ground below the emitter.
struct Path {
  double distance_m = 0;
  int before = 0;  ///< last post before the receivers
  int blocks = 0;
  int chords = 0;
  TerrainChord chord[kMaxChords];
  double chord_end_m[kMaxChords];
  float corner_column[kMaxChords], corner_row[kMaxChords];  ///< the chord's corner in the raster
  float base_msl_m = 0;
  float tx_m = 0;
};

/// Memory of a path's blocks and posts.
struct PathMemory {
  float *column, *row, *lowered_m, *tx_bound, *bound;
  float* height_m;
  int *window, *is_read;
};

/// A search for a maximum of the posts of a path.
struct Maximum {
  float value;
  int block;  ///< that holds it
};

/// Sets lowered_m of all blocks. @return false if a block is not in one window, or its bound is unknown
inline bool boundBlocks(const Paths& paths, const Path& path, const PathMemory& memory) {
  constexpr float kMargin = 0.02f;  // posts: for rounding, and for the curvature of a block
  float* const columns = memory.column;
  float* const rows = memory.row;
  const double* const begin_m = paths.begin_m;
  int block = 0;
  for (int n = 0; n < path.chords; ++n) {
    const TerrainChord chord = path.chord[n];
    const double* const end_m = std::lower_bound(begin_m + block, begin_m + path.blocks, path.chord_end_m[n]);
    const int end = static_cast<int>(end_m - begin_m);
    const float column = path.corner_column[n], row = path.corner_row[n];
#pragma omp simd
    for (int b = block; b < end; ++b) {
      const float part = chord.partAt(begin_m[b]);
      columns[b] = column + chord.column.at(part);
      rows[b] = row + chord.row.at(part);
    }
    block = end;
  }
  const int last = path.chords - 1, blocks = path.blocks;
  const float part = path.chord[last].partAt(path.distance_m);
  columns[blocks] = path.corner_column[last] + path.chord[last].column.at(part);
  rows[blocks] = path.corner_row[last] + path.chord[last].row.at(part);

  int* const windows = memory.window;
  const int row_windows = paths.row_windows;
  float extent = 0;
#pragma omp simd reduction(max : extent)
  for (int b = 0; b < blocks; ++b) {
    const float column0 = columns[b], column1 = columns[b + 1], row0 = rows[b], row1 = rows[b + 1];
    const float column = column0 < column1 ? column0 : column1, row = row0 < row1 ? row0 : row1;
    const float across = std::fabs(column1 - column0), along = std::fabs(row1 - row0);
    const float longer = across > along ? across : along;
    extent = longer > extent ? longer : extent;
    constexpr float kPerStride = 1.0f / TerrainBounds::kStride;
    const int i = static_cast<int>((column - kMargin) * kPerStride);
    const int j = static_cast<int>((row - kMargin) * kPerStride);
    windows[b] = j * row_windows + i;
  }
  const float* const window_msl_m = paths.window_msl_m;
  const float* const first_bulge_m = paths.first_bulge_m;
  float* const lowered_m = memory.lowered_m;
  const float base_m = path.base_msl_m;
  float highest = -HUGE_VALF;
#pragma omp simd reduction(max : highest)
  for (int b = 0; b < blocks; ++b) {
    const float bound_m = window_msl_m[windows[b]];
    highest = bound_m > highest ? bound_m : highest;
    lowered_m[b] = bound_m - base_m - first_bulge_m[b];
  }
  std::fill_n(memory.is_read, blocks, 0);
  return extent + 2 * kMargin <= TerrainBounds::kMaxExtent && highest < HUGE_VALF;
}

/// Posts of a block, relative to the base.
inline const float* heightsOf(const Paths& paths, const Path& path, const PathMemory& memory, int block) {
  const int first = block * kBlock, end = std::min(first + kBlock, path.before + 1);
  float* const height_m = memory.height_m + first;
  if (memory.is_read[block] != 0) return height_m;
  memory.is_read[block] = 1;
  const double* const range_m = paths.range_m + first;
  int n = 0;
  while (range_m[0] >= path.chord_end_m[n]) ++n;
  const float base_m = path.base_msl_m;
  if (range_m[end - first - 1] < path.chord_end_m[n]) {
    const TerrainChord chord = path.chord[n];
#pragma omp simd
    for (int i = 0; i < end - first; ++i) height_m[i] = chord.heightInRaster(range_m[i]) - base_m;
  } else {
    for (int i = 0; i < end - first; ++i) {
      while (range_m[i] >= path.chord_end_m[n]) ++n;
      height_m[i] = path.chord[n].heightInRaster(range_m[i]) - base_m;
    }
  }
  return height_m;
}

/// Calls valueOf(range_m, height_m) for the obstacles of a block, and takes the largest value.
template <class ValueOf>
inline void visit(const Paths& paths, const Path& path, const PathMemory& memory, int block,
                  const ValueOf& valueOf, Maximum& most) {
  const int first = block * kBlock, end = std::min(first + kBlock, path.before + 1);
  const float* const height_m = heightsOf(paths, path, memory, block);
  const float* const range_m = paths.obstacle_m + first;
  float largest = -HUGE_VALF;
#pragma omp simd reduction(max : largest)
  for (int i = first == 0 ? 1 : 0; i < end - first; ++i) {
    const float value = valueOf(range_m[i], height_m[i]);
    largest = value > largest ? value : largest;
  }
  if (largest > most.value) most = {largest, block};
}

/// Visits the blocks whose bound is above the maximum, from the receivers to the transmitter.
template <class ValueOf>
inline void visitAbove(const Paths& paths, const Path& path, const PathMemory& memory, const float* bound,
                       int guess, const ValueOf& valueOf, Maximum& most) {
  guess = std::min(guess, path.blocks - 1);
  if (bound[guess] > most.value) visit(paths, path, memory, guess, valueOf, most);
  for (int b = path.blocks - 1; b >= 0; --b) {
    if (bound[b] > most.value && b != guess) visit(paths, path, memory, b, valueOf, most);
  }
}

/// Losses of receivers clear of the smooth earth, lowest first.
/// @param ray_bound  of the slopes from the transmitter to each block; null: none
/// @param rx_m      heights, relative to the base
/// @param tx_block, rx_block, nu_block  where the searches start; set to where they ended
/// @return false if bounds are missing
EMSCAPE_SIMD_CLONES bool findLosses(const Paths& all_paths, const Path& path, const PathMemory& path_memory,
                                    const float* ray_bound, const float* rx_m, int count, int& tx_block,
                                    int* rx_block, int* nu_block, float* loss_db) {
  const Paths paths = all_paths;  // no store changes these
  const PathMemory memory = path_memory;
  if (!boundBlocks(paths, path, memory)) return false;
  const auto d = static_cast<float>(path.distance_m);
  const float k = paths.model.half_curvature, bulge = k * d, tx_m = path.tx_m;
  const int blocks = path.blocks;
  const float before_m = paths.obstacle_m[path.before];

#pragma omp simd
  for (int b = 0; b < blocks; ++b) {
    const float lowered = memory.lowered_m[b] - tx_m;
    memory.tx_bound[b] = lowered / (lowered > 0 ? paths.first_m[b] : paths.last_m[b]);
  }
  if (ray_bound != nullptr) {
#pragma omp simd
    for (int b = 0; b < blocks; ++b) {
      memory.tx_bound[b] = ray_bound[b] < memory.tx_bound[b] ? ray_bound[b] : memory.tx_bound[b];
    }
  }
  Maximum steepest{-HUGE_VALF, tx_block};
  visitAbove(
      paths, path, memory, memory.tx_bound, tx_block,
      [=](float range, float height) { return (height - k * range * range - tx_m) * (1 / range); }, steepest);
  tx_block = steepest.block;

  for (int n = 0; n < count; ++n) {
    const float slope = (rx_m[n] - tx_m) / d;
    float nu;
    if (steepest.value + bulge >= slope) {
      const float rx = rx_m[n];
#pragma omp simd
      for (int b = 0; b < blocks; ++b) {
        const float above = memory.lowered_m[b] + bulge * d - rx;
        const float last_m = paths.last_m[b] < before_m ? paths.last_m[b] : before_m;
        memory.bound[b] = above / (d - (above > 0 ? last_m : paths.first_m[b])) - bulge;
      }
      Maximum most{-HUGE_VALF, rx_block[n]};
      visitAbove(
          paths, path, memory, memory.bound, rx_block[n],
          [=](float range, float height) { return (height - rx) * (1 / (d - range)) + k * range; }, most);
      rx_block[n] = most.block;
      nu = propagation::bullingtonEdgeNu(paths.model, d, slope, steepest.value + bulge, most.value);
    } else {
      const float factor2 = 2 * d / paths.model.earth.wavelength_m, rise = bulge - slope;
#pragma omp simd
      for (int b = 0; b < blocks; ++b) {
        const float first_m = paths.first_m[b], half = d / 2;
        const float last_m = paths.last_m[b] < before_m ? paths.last_m[b] : before_m;
        const float above = memory.lowered_m[b] - tx_m + rise * (rise > 0 ? last_m : first_m);
        const float widest = half < first_m ? first_m : half > last_m ? last_m : half;
        const float below = -above * std::sqrt(factor2 / (widest * (d - widest)));
        memory.bound[b] = above >= 0 ? HUGE_VALF : -below;
      }
      Maximum most{propagation::kKnifeEdgeClear<float>, nu_block[n]};
      visitAbove(
          paths, path, memory, memory.bound, nu_block[n],
          [=](float range, float height) {
            const float beyond = d - range;
            return (height - tx_m + k * range * beyond - slope * range) *
                   std::sqrt(factor2 / (range * beyond));
          },
          most);
      nu_block[n] = most.block;
      nu = most.value;
      if (nu <= propagation::kKnifeEdgeClear<float>) {  // and so are those above
        for (; n < count; ++n) loss_db[n] = 0;
        return true;
      }
    }
    loss_db[n] = propagation::bullingtonLossDb(nu, d);
  }
  return true;
}

/// Sets the chords of a path. @return false if they are too many, or not all in the finest raster
bool findChords(const Station& station, const scenario::TerrainView& terrain, const FastInverse& point,
                Path& path) {
  TerrainWalk walk(station, terrain, point);
  double range_m = 0;
  for (path.chords = 0; range_m < point.distance_m;) {
    if (path.chords == kMaxChords) return false;
    const TerrainChord& chord = walk.chordAt(range_m);
    if (chord.corner_msl_m == nullptr) return false;
    const int n = path.chords++;
    path.chord[n] = chord;
    const auto corner = chord.corner_msl_m - terrain.rasters[0].heights_msl_m;
    path.corner_row[n] = static_cast<float>(corner / chord.row_posts);
    path.corner_column[n] = static_cast<float>(corner % chord.row_posts);
    path.chord_end_m[n] = walk.endOfChord_m(range_m);
    constexpr double kBeyond_m = 1e-6;  // so that rounding does not find the same chord again
    range_m = path.chord_end_m[n] + kBeyond_m;
  }
  return path.chords > 0;
}

}  // namespace

SurfaceDiffraction::SurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task,
                                       const TerrainBounds& bounds)
    : task_(task), bounds_(bounds) {
  const GroundPosts& ground = task.ground;
  for (int i = 0; i < ground.range_count; ++i) range_m_.push_back(static_cast<float>(ground.ranges_m[i]));
  for (int first = 0; first < ground.range_count; first += kBlock) {
    const int first_obstacle = std::max(first, 1), last = std::min(first + kBlock, ground.range_count) - 1;
    begin_m_.push_back(ground.ranges_m[first]);
    first_m_.push_back(range_m_[first_obstacle]);
    last_m_.push_back(range_m_[std::max(last, first_obstacle)]);
    first_bulge_m_.push_back(task.model.model.half_curvature * first_m_.back() * first_m_.back());
  }
  boundRays();
}

void SurfaceDiffraction::boundRays() {
  // Rays are a small part of the paths; fewer than kMinRays bound nothing.
  constexpr double kSpacing_m = 50;
  constexpr int kPathsPerRay = 100, kMinRays = 360;
  const GroundPosts& ground = task_.ground;
  const double farthest_m = ground.ranges_m[ground.range_count - 1];
  rays_ = static_cast<int>(std::min(2 * kPi * farthest_m / kSpacing_m,
                                    static_cast<double>(task_.grid.column_count / kPathsPerRay)));
  const double between = bounds_.steepest() * kPi / rays_;  // slope from a ray to half way to the next
  if (rays_ < kMinRays || !(between < 0.1)) {
    rays_ = 0;
    return;
  }
  constexpr double kRounding = 1e-6;
  const auto slack = static_cast<float>(between + kRounding);
  const std::size_t blocks = begin_m_.size();
  const float k = task_.model.model.half_curvature;
  ray_bounds_.resize(rays_ * blocks);
  parallelFor(rays_, 16, [&](int begin, int end) {
    std::vector<float> heights_m(range_m_.size());
    for (int ray = begin; ray < end; ++ray) {
      const double azimuth_rad = 2 * kPi * ray / rays_;
      readPostsCpu(task_.station, ground, {farthest_m, std::sin(azimuth_rad), std::cos(azimuth_rad)},
                   ground.range_count, heights_m.data());
      const float tx_msl_m = task_.model.model.raised_m(task_.model.tx_msl_m, heights_m[0]);
      for (std::size_t b = 0; b < blocks; ++b) {
        const std::size_t first = std::max<std::size_t>(b * kBlock, 1);
        const std::size_t last = std::min((b + 1) * kBlock, heights_m.size());
        float largest = -HUGE_VALF, unknown = 0;
        for (std::size_t i = first; i < last; ++i) {
          const float slope = (heights_m[i] - k * range_m_[i] * range_m_[i] - tx_msl_m) / range_m_[i];
          largest = slope > largest ? slope : largest;
          unknown += heights_m[i] - heights_m[i];
        }
        ray_bounds_[ray * blocks + b] = unknown == 0 ? largest + slack : HUGE_VALF;
      }
    }
  });
}

SurfaceDiffraction::Memory SurfaceDiffraction::makeMemory() const {
  Memory memory;
  const std::size_t blocks = begin_m_.size() + 1;
  memory.per_block.resize(kBlockNumbers * blocks);
  memory.height_m.resize(blocks * kBlock);
  memory.of_block.resize(2 * blocks);
  memory.rx_block.resize(task_.grid.layers);
  memory.nu_block.resize(task_.grid.layers);
  return memory;
}

bool SurfaceDiffraction::fillColumn(std::size_t c, const ExcessScratch& scratch, Memory& memory) const {
  constexpr int kMinPosts = 4 * kBlock;  // shorter paths are read as fast
  const ExcessGrid& grid = task_.grid;
  const DiffractionModel<float>& model = task_.model.model;
  const FastInverse point = grid.coordinatesOf(task_.station, c, 0);
  Path path;
  path.distance_m = point.distance_m;
  path.before = task_.ground.lastBefore(point.distance_m);
  path.blocks = path.before / kBlock + 1;
  if (path.before < kMinPosts || !findChords(task_.station, task_.ground.terrain, point, path)) return false;
  path.base_msl_m = path.chord[0].heightInRaster(0);
  path.tx_m = model.raised_m(task_.model.tx_msl_m - path.base_msl_m, 0);
  const float ground_m = grid.ground_msl_m[c] - path.base_msl_m;
  for (int k = 0; k < grid.layers; ++k) {
    const auto height_msl_m =
        static_cast<float>(heightMsl_m(grid.columns[c], static_cast<double>(grid.t_m[k])));
    scratch.height_msl_m[k] =
        model.raised_m(task_.modelHeight_m(point.distance_m, height_msl_m) - path.base_msl_m, ground_m);
  }
  // The antennas are at least as high above the smooth earth as above their ground.
  const auto distance = static_cast<float>(point.distance_m);
  const float rx_agl_m = scratch.height_msl_m[0] - ground_m;
  if (!isClearThroughout(model.earth, distance, sightLine(model.earth, distance, path.tx_m, rx_agl_m))) {
    return false;
  }
  const Paths paths{
      model,          task_.ground.ranges_m, range_m_.data(),         begin_m_.data(),     first_m_.data(),
      last_m_.data(), first_bulge_m_.data(), bounds_.highest_msl_m(), bounds_.rowWindows()};
  const std::size_t blocks = begin_m_.size() + 1;
  const auto numbers = [&](BlockNumber n) { return memory.per_block.data() + n * blocks; };
  const PathMemory of_path{
      numbers(kColumn), numbers(kRow),          numbers(kLowered),      numbers(kTxBound),
      numbers(kBound),  memory.height_m.data(), memory.of_block.data(), memory.of_block.data() + blocks};
  const float* ray_bound = nullptr;
  if (rays_ > 0) {
    const double turns = std::atan2(point.sin_azimuth, point.cos_azimuth) / (2 * kPi);
    const int ray = static_cast<int>(std::lround((turns < 0 ? turns + 1 : turns) * rays_)) % rays_;
    ray_bound = ray_bounds_.data() + ray * begin_m_.size();
  }
  if (!findLosses(paths, path, of_path, ray_bound, scratch.height_msl_m, grid.layers, memory.tx_block,
                  memory.rx_block.data(), memory.nu_block.data(), scratch.excess_db)) {
    return false;
  }
  propagation::ExcessColumn column;
  column.range_m = point.distance_m;
  task_.addAir(c, 0, column, 0, grid.layers, scratch.excess_db);
  return true;
}

}  // namespace emscape::emfield
