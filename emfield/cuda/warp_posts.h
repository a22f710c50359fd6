/// Paths over the ground, each read by a warp whose lanes hold posts; for nvcc.
///
/// A warp prepares some columns at a time, a lane a column or a chord, because the geodesy of a path takes as
/// many instructions as hundreds of its posts.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>

#include "emfield/cuda/column_tiles.h"
#include "emfield/ground/chord_crossings.h"

namespace emscape::emfield::cuda {

constexpr unsigned kAllLanes = 0xffffffffu;
constexpr int kWarpLanes = 32;

/// The largest value of the lanes, in all of them; no value is NaN.
__device__ inline float largestOfWarp(float value) {
  // As integers in the same order.
  const auto ordered = [](int bits) { return bits >= 0 ? bits : bits ^ 0x7fffffff; };
  return __int_as_float(ordered(__reduce_max_sync(kAllLanes, ordered(__float_as_int(value)))));
}
__device__ inline float sumOfWarp(float value) {
  for (int step = kWarpLanes / 2; step > 0; step /= 2) value += __shfl_xor_sync(kAllLanes, value, step);
  return value;
}

/// The path to a segment of a column.
struct WarpPath {
  FastInverse to;
  int posts;       ///< regular ones nearer than the column, with the emitter's; 0: there is no path
  int chords;      ///< of a walk
  double chord_m;  ///< length of a chord
};

/// A part of a path, with the regular posts first..end - 1 beyond its beginning.
struct WarpChord {
  TerrainChord chord;
  int first, end;
  int crossing_count;  ///< -1: there are none, or too many
  ChordCrossings crossings;
};

/// Paths and chords of a warp, in shared memory, which is not initialised.
struct WarpMemory {
  static constexpr int kPaths = 8;

  WarpPath paths[kPaths];
  WarpChord chords[kPaths];
};
/// Memory of a warp, of a block of kColumnThreads.
__device__ inline WarpMemory& warpMemory() {
  __shared__ alignas(WarpMemory) unsigned char memory[kColumnThreads / kWarpLanes * sizeof(WarpMemory)];
  return reinterpret_cast<WarpMemory*>(memory)[threadIdx.x / kWarpLanes];
}

/// A separate call, so that its registers are not part of those of the loops over posts.
__device__ __noinline__ inline void prepareChord(const Station& station, const GroundPosts& ground,
                                                 const WarpPath& path, int number, WarpChord& to) {
  to.crossing_count = -1;
  if (!ground.is_smooth) {
    to.chord = TerrainWalk(station, ground.terrain, path.to).chord(number);
    if (to.chord.in_raster.corner_msl_m != nullptr) {
      to.crossings = ChordCrossings(to.chord.in_raster);
      const int count = to.crossings.count();
      if (count <= ground.maxCrossings(path.chord_m)) to.crossing_count = count;
    }
  }
  const double begin_m = number * path.chord_m;
  to.first = number == 0 ? 1 : min(ground.lastBefore(begin_m) + 1, path.posts);
  to.end = number + 1 == path.chords ? path.posts : ground.lastBefore(begin_m + path.chord_m) + 1;
}

/// Some chords of a path, by a warp.
__device__ __noinline__ inline void prepareChords(const Station& station, const GroundPosts& ground,
                                                  const WarpPath& path, int begin, int end, WarpChord* to) {
  __syncwarp();
  const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
  if (begin + lane < end) prepareChord(station, ground, path, begin + lane, to[lane]);
  __syncwarp();
}

/// Where the finest raster has no height.
__device__ __noinline__ inline float heightAmongRasters(const GroundPosts& ground, const TerrainChord& chord,
                                                        double range_m) {
  return chord.heightAmongRasters(ground.terrain, range_m);
}

/// Height of the clutter at a post, if it is an obstacle.
__device__ __noinline__ inline float clutterAt(const GroundPosts& ground, const TerrainChord& chord,
                                               double range_m, double distance_m, float ground_msl_m) {
  if (!(range_m > kClutterFree_m && range_m < distance_m - kClutterFree_m)) return 0;
  const double part = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
  const float cover_m = ground.terrain.coverAt(chord.position.latitude_rad.at(part),
                                               chord.position.longitude_rad.at(part), ground_msl_m);
  return cover_m > 0 ? cover_m : 0;
}

/// A post of a path.
struct PathPost {
  float range_m, height_msl_m;
};

/// Memory for the posts of a warp's path, one after another: shared memory, or memory of the device where
/// that has no room.
class PathMemory {
 public:
  static constexpr int kMostShared = 3000;

  /// @param posts  of the longest path
  PathMemory(const ScratchMemory& scratch, int posts) : posts_(posts) {
    if (posts <= kMostShared) return;
    const std::size_t bytes_each = static_cast<std::size_t>(posts) * sizeof(PathPost) * kWarps;
    blocks_ = static_cast<int>(std::min<std::size_t>(scratch.bytes / bytes_each, 1 << 20));
    if (blocks_ == 0) throwTooSmall(bytes_each / kColumnThreads, scratch.bytes);
    scratch_ = static_cast<PathPost*>(scratch.data);
  }
  /// Of a kernel: its blocks, at most, and their shared memory.
  int mostBlocks() const { return blocks_; }
  std::size_t sharedBytes() const { return scratch_ == nullptr ? sizeof(PathPost) * posts_ * kWarps : 0; }

  __device__ PathPost* ofWarp() const {
    extern __shared__ PathPost shared_posts[];
    const int warp = static_cast<int>(threadIdx.x) / kWarpLanes;
    if (scratch_ == nullptr) return shared_posts + warp * posts_;
    return scratch_ + static_cast<long long>(blockIdx.x * kWarps + warp) * posts_;
  }

 private:
  static constexpr int kWarps = kColumnThreads / kWarpLanes;

  int posts_;
  int blocks_ = 1 << 30;
  PathPost* scratch_ = nullptr;
};

/// Of a path's length, at most: a post may be at the receivers in float.
constexpr float kNearerThanEnd = 1 - 2.4e-7f;

/// Reads the posts of a path. All lanes of the warp call its functions together.
class WarpPosts {
 public:
  /// @param chords   room for WarpMemory::kPaths
  /// @param first    index of the path's first chord there
  /// @param prepared number of the path's chords that are there
  __device__ WarpPosts(const Station& station, const GroundPosts& ground, const WarpPath& path,
                       WarpChord* chords, int first, int prepared)
      : station_(station),
        ground_(ground),
        path_(path),
        chords_(chords),
        first_(first),
        end_(prepared),
        is_smooth_(ground.is_smooth),
        is_raised_(ground.is_raised) {}

  /// Calls visit(post, range (m), height above mean sea level (m)) for the regular posts that are nearer than
  /// the column, from the emitter's on, each in one lane.
  template <class Visit>
  __device__ void eachRegular(const Visit& visit) {
    for (int n = 0; n < path_.chords; ++n) {
      const WarpChord& part = chord(n);
      eachRegular(part, n == 0 ? 0 : part.first, visit);
    }
  }

  /// Stores the posts between emitter and column in their order, and the emitter's.
  /// @param at_crossings  false: regular posts; true: those of chord_crossings.h
  /// @return their number
  __device__ int read(bool at_crossings, PathPost* to) {
    const auto store = [&](int at, double range_m, float height_msl_m) {
      to[at] = {fminf(static_cast<float>(range_m), farthest_m()), height_msl_m};
    };
    __syncwarp();  // those of the last path were read
    if (is_smooth_ || !at_crossings) {
      eachRegular(store);
      __syncwarp();
      return path_.posts;
    }
    int count = 0;
    for (int n = 0; n < path_.chords; ++n) {
      const WarpChord& part = chord(n);
      const double begin_m = n * path_.chord_m;
      if (lane() == 0) store(count, begin_m, heightAt(part.chord, part.chord.in_raster, begin_m));
      ++count;
      const int crossings = part.crossing_count < 0 ? -1 : readCrossings(part, begin_m, n == 0, to + count);
      if (crossings >= 0) {
        count += crossings;
        continue;
      }
      const bool is_twice = part.first < part.end && ground_.ranges_m[part.first] <= begin_m;
      const int first = part.first + (is_twice ? 1 : 0);
      eachRegular(part, first, [&](int i, double range_m, float height_msl_m) {
        store(count + i - first, range_m, height_msl_m);
      });
      count += max(part.end - first, 0);
    }
    __syncwarp();
    return count;
  }

 private:
  static __device__ int lane() { return static_cast<int>(threadIdx.x) % kWarpLanes; }
  __device__ float farthest_m() const { return static_cast<float>(path_.to.distance_m) * kNearerThanEnd; }

  /// Chord n of the path; those of paths with many are prepared again.
  __device__ const WarpChord& chord(int n) {
    if (n < begin_ || n >= end_) {
      first_ = 0;
      begin_ = n;
      end_ = min(n + WarpMemory::kPaths, path_.chords);
      prepareChords(station_, ground_, path_, begin_, end_, chords_);
    }
    return chords_[first_ + n - begin_];
  }
  /// Height above mean sea level (m), with the clutter where that counts; NaN over missing terrain.
  __device__ float heightAt(const TerrainChord& chord, const RasterChord& in_raster, double range_m) const {
    if (is_smooth_) return 0;
    const float height_msl_m = in_raster.corner_msl_m != nullptr ? in_raster.heightAt(range_m) : NAN;
    return raised(chord, range_m,
                  isnan(height_msl_m) ? heightAmongRasters(ground_, chord, range_m) : height_msl_m);
  }
  __device__ float raised(const TerrainChord& chord, double range_m, float height_msl_m) const {
    if (!is_raised_) return height_msl_m;
    return height_msl_m + clutterAt(ground_, chord, range_m, path_.to.distance_m, height_msl_m);
  }
  template <class Visit>
  __device__ void eachRegular(const WarpChord& part, int first, const Visit& visit) const {
    const double* const ranges_m = ground_.ranges_m;
    const RasterChord in_raster = part.chord.in_raster;
    const int end = part.end;
#pragma unroll 1
    for (int i = first + lane(); i < end; i += kWarpLanes)
      visit(i, ranges_m[i], heightAt(part.chord, in_raster, ranges_m[i]));
  }

  /// Stores the posts of a chord beyond its beginning, which is at to[-1].
  /// @return their number; -1 if the chord has regular posts
  __device__ int readCrossings(const WarpChord& part, double begin_m, bool is_first, PathPost* to) const {
    const TerrainChord& chord = part.chord;
    const ChordCrossings crossings = part.crossings;
    const int count = part.crossing_count, columns = crossings.columns.count;
    const int near = is_first ? min(max(ground_.near_count, 1), part.end) - 1 : 0;
    PathPost* const others = to + near;
#pragma unroll 1
    for (int i = lane(); i < count; i += kWarpLanes) others[i].range_m = -1;
    __syncwarp();
    float unknown = 0;
#pragma unroll 1
    for (int n = lane(); n < count; n += kWarpLanes) {
      const Crossing at = n < columns ? crossings.atColumn(n) : crossings.atRow(n - columns);
      const double range_m = crossingRange_m(begin_m, path_.chord_m, at.part, path_.to.distance_m);
      unknown += at.height_msl_m - at.height_msl_m;
      others[at.place - 1] = {static_cast<float>(range_m), raised(chord, range_m, at.height_msl_m)};
    }
    __syncwarp();
    if (!__all_sync(kAllLanes, unknown == 0)) return -1;
#pragma unroll 1
    for (int i = lane(); i < count; i += kWarpLanes) {  // empty at posts of the raster: see Crossing
      if (others[i].range_m < 0) others[i] = i > 0 ? others[i - 1] : to[-1];
    }
    __syncwarp();
    if (near > 0) addNear(chord, near, count, to);
    return near + count;
  }

  /// Puts the regular posts 1..near in order with others, at to[near].
  __device__ void addNear(const TerrainChord& chord, int near, int others, PathPost* to) const {
    const double* const ranges_m = ground_.ranges_m;
    const auto last_m = static_cast<float>(ranges_m[near]);
    // The others that are nearer than the last one are few.
    const int mine = lane();
    const float other_m = mine < others ? to[near + mine].range_m : HUGE_VALF;
    const float other_msl_m = mine < others ? to[near + mine].height_msl_m : 0;
    const int moved = __popc(__ballot_sync(kAllLanes, other_m < last_m));
    int after = 0;  // of the lane's other: posts before it
    for (int first = 1; first <= near; first += kWarpLanes) {
      const int i = first + mine;
      const double range_m = ranges_m[min(i, near)];
      const float near_m = i <= near ? static_cast<float>(range_m) : HUGE_VALF;
      int before = 0;
      for (int other = 0; other < moved; ++other) {
        const float here_m = __shfl_sync(kAllLanes, other_m, other);
        const int nearer = __popc(__ballot_sync(kAllLanes, near_m <= here_m));
        if (mine == other) after += nearer;
        before += here_m < near_m ? 1 : 0;
      }
      if (i <= near) to[i - 1 + before] = {near_m, heightAt(chord, chord.in_raster, range_m)};
    }
    if (mine < moved) to[mine + after] = {other_m, other_msl_m};
    __syncwarp();
  }

  const Station& station_;
  const GroundPosts& ground_;
  const WarpPath& path_;
  WarpChord* chords_;
  int first_, begin_ = 0, end_;  ///< chords begin_..end_ - 1 are in chords_ from first_ on
  bool is_smooth_, is_raised_;
};

/// Columns of a warp: nearly square, because they share more data than those of a row.
constexpr int kWarpColumns = 4, kWarpRows = 2;
static_assert(kWarpColumns * kWarpRows == WarpMemory::kPaths);

/// Tiles of kWarpColumns x kWarpRows columns over a grid's rows, of all tasks; a warp each.
class WarpTiles {
 public:
  /// @param row  columns along x
  WarpTiles(const ExcessGrid& grid, int row, int tasks) : row_(row) {
    const int rows = static_cast<int>(grid.column_count) / row;
    along_x_ = (row + kWarpColumns - 1) / kWarpColumns;
    of_task_ = along_x_ * ((rows + kWarpRows - 1) / kWarpRows);
    count_ = static_cast<long long>(of_task_) * tasks;
  }
  /// For one tile per warp. @param most  blocks, each of which then has several
  unsigned blocks(int most = 1 << 30) const {
    constexpr int kWarps = kColumnThreads / kWarpLanes;
    return static_cast<unsigned>(std::min<long long>((count_ + kWarps - 1) / kWarps, most));
  }
  /// Calls f(task, tile) for the tiles of a warp.
  template <class Function>
  __device__ void eachTile(const Function& f) const {
    const long long warps = static_cast<long long>(gridDim.x) * blockDim.x / kWarpLanes;
    for (long long n = (static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x) / kWarpLanes;
         n < count_; n += warps) {
      f(static_cast<int>(n / of_task_), static_cast<int>(n % of_task_));
    }
  }
  /// A column of a tile, 0..WarpMemory::kPaths - 1; -1: outside the grid.
  __device__ int columnOf(const ExcessGrid& grid, int tile, int n) const {
    const int x = tile % along_x_ * kWarpColumns + n % kWarpColumns;
    const int y = tile / along_x_ * kWarpRows + n / kWarpColumns;
    return x < row_ && static_cast<std::size_t>(y) * row_ < grid.column_count ? y * row_ + x : -1;
  }

 private:
  int row_, along_x_, of_task_;
  long long count_;
};

/// Calls visit(column, path, WarpPosts) for the columns of a warp's tile that have a path, each by all lanes.
/// @param has_path(column)  false: without a path to it
template <class HasPath, class Visit>
__device__ void eachPath(const Station& station, const GroundPosts& ground, const ExcessGrid& grid,
                         const WarpTiles& tiles, int tile, int segment, WarpMemory& memory,
                         const HasPath& has_path, const Visit& visit) {
  const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
  constexpr int kPaths = WarpMemory::kPaths;
  int chords = 0;
  __syncwarp();
  if (lane < kPaths) {
    WarpPath path{};
    const int c = tiles.columnOf(grid, tile, lane);
    if (c >= 0 && has_path(c)) path.to = grid.coordinatesOf(station, static_cast<std::size_t>(c), segment);
    if (path.to.distance_m > 0) {
      path.posts = ground.lastBefore(path.to.distance_m) + 1;
      const TerrainWalk walk(station, ground.terrain, path.to);
      path.chords = chords = ground.is_smooth ? 1 : walk.chords();
      path.chord_m = ground.is_smooth ? path.to.distance_m : walk.chord_m();
    }
    memory.paths[lane] = path;
  }
  const int most = __reduce_max_sync(kAllLanes, chords);
  if (most == 0) return;
  const int room = min(most, kPaths), together = kPaths / room;
  for (int first = 0; first < kPaths; first += together) {
    __syncwarp();
    const int mine = first + lane / room, number = lane % room;
    if (lane < together * room && mine < kPaths && number < memory.paths[mine].chords)
      prepareChord(station, ground, memory.paths[mine], number, memory.chords[lane]);
    __syncwarp();
    for (int n = first; n < min(first + together, kPaths); ++n) {
      const WarpPath& path = memory.paths[n];
      if (path.posts == 0) continue;
      visit(tiles.columnOf(grid, tile, n), path,
            WarpPosts(station, ground, path, memory.chords, (n - first) * room, min(path.chords, room)));
    }
  }
}

}  // namespace emscape::emfield::cuda
