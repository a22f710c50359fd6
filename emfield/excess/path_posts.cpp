#include "emfield/excess/path_posts.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

constexpr int kBlock = SectorPosts::kBlock;
constexpr int kCrossings = PathPosts::kCrossings, kOfBlock = PathPosts::kOfBlock;
static_assert(kOfBlock == kCrossings + kBlock);

/// The crossings of a short straight part of a path with columns or rows.
struct Lines {
  float begin, length;  ///< coordinate whose integers are the lines
  float per_length;
  int first, step, count;

  /// @param overlap  the part begins earlier by this
  Lines(float begin_at, float end_at, float overlap) : begin(begin_at), length(end_at - begin_at) {
    const bool rises = length > 0;
    const int cell = static_cast<int>(rises ? begin - overlap : begin + overlap),
              last = static_cast<int>(end_at);
    first = rises ? cell + 1 : cell;
    step = rises ? 1 : -1;
    count = rises ? last - cell : cell - last;
    per_length = count > 0 ? 1 / length : 0;
  }
};

/// A block's part of a path, and its raster.
struct CrossingTask {
  Lines columns, rows;
  const float* corner_msl_m;
  int row_posts;
  float base_msl_m, first_m, length_m;
};

using Floats = float __attribute__((vector_size(kOfBlock * sizeof(float))));
using Ints = int __attribute__((vector_size(kOfBlock * sizeof(int))));

/// Reads the crossings; other places are below everything. By vectors: g++ makes branches of a loop.
inline void readCrossingsOfBlock(const CrossingTask& task, float* range_m, float* height_m) {
  const Lines &columns = task.columns, &rows = task.rows;
  const Floats zero{}, one = zero + 1;
  const Ints number{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Ints on_column = number < columns.count, is_used = number < columns.count + rows.count;
  const Ints of_row = is_used & (number - columns.count);
  const Ints line = on_column ? columns.first + columns.step * number : rows.first + rows.step * of_row;
  const Floats begin = on_column ? zero + columns.begin : zero + rows.begin;
  const Floats along = (__builtin_convertvector(line, Floats) - begin) *
                       (on_column ? zero + columns.per_length : zero + rows.per_length);
  const Floats part = along > 0 ? (along < 1 ? along : one) : zero;
  const Floats x = columns.begin + part * columns.length, y = rows.begin + part * rows.length;
  const Floats across = on_column ? y : x;
  const Ints cell = __builtin_convertvector(across, Ints);
  const Ints post = (on_column ? cell : line) * task.row_posts + (on_column ? line : cell);
  const Ints next = post + (on_column ? Ints{} + task.row_posts : Ints{} + 1);
  Floats near_msl_m, next_msl_m;
  for (int n = 0; n < kOfBlock; ++n) near_msl_m[n] = task.corner_msl_m[post[n]];
  for (int n = 0; n < kOfBlock; ++n) next_msl_m[n] = task.corner_msl_m[next[n]];
  const Floats to_next = across - __builtin_convertvector(cell, Floats);
  const Floats above_m = near_msl_m + to_next * (next_msl_m - near_msl_m) - task.base_msl_m;
  const Floats at_m = task.first_m + part * task.length_m, here_m = is_used ? above_m : zero - HUGE_VALF;
  std::memcpy(range_m, &at_m, sizeof at_m);
  std::memcpy(height_m, &here_m, sizeof here_m);
}

}  // namespace

PathPosts::PathPosts(const SectorObstacles& obstacles, const SectorTerrain& terrain, const BlockCover* cover,
                     double sine_of_latitude)
    : obstacles_(obstacles),
      terrain_(terrain),
      cover_(cover),
      longest_chord_m_(static_cast<float>(maxChord_m(sine_of_latitude))) {
  constexpr double kOf75Degrees = 0.965925826289068;
  longest_chord_beside_m_ = sine_of_latitude < kOf75Degrees ? 0.02f : 0.1f;  // see terrain_walk.h
  const auto blocks = static_cast<std::size_t>(obstacles.posts.blocks());
  for (auto* const posts : {&range_m_, &height_m_}) posts->resize(blocks * kOfBlock);
  for (auto* const of_blocks : {&read_for_, &raised_for_, &clutter_read_for_, &columns_, &used_})
    of_blocks->resize(blocks);
  doubtful_.resize(blocks);
}

void PathPosts::begin(const PathToRead& path) {
  constexpr float kRounding_m = 0.005f;
  path_ = &path;
  ++number_;
  is_left_ = false;
  chord_m_ = path.distance_m / (std::floor(path.distance_m / longest_chord_m_) + 1);
  const float part = chord_m_ / longest_chord_m_;  // the deviation grows by the cube
  clutter_m_.clear();
  clutter_posts_.clear();
  const GroundPosts& ground = obstacles_.ground;
  mirrored_m_ = static_cast<float>(
      ground.has_clutter ? path.exact_distance_m - ground.ranges_m[ground.clutter_end] : HUGE_VAL);
  beside_m_ = kRounding_m + longest_chord_beside_m_ * part * part * part;
}

inline PathPosts::Part PathPosts::partIn(int block) const {
  const SectorPosts& posts = obstacles_.posts;
  const SectorChord& chord = terrain_.chord(block / posts.blocksPerChord());
  const float first_m = posts.first_m()[block], whole_m = posts.last_m()[block] - first_m;
  const float length_m = std::min(posts.last_m()[block], path_->last_m) - first_m;
  const float begin = posts.firstPart()[block], end = posts.lastPart()[block];
  // Exactly where the next block begins, if the path reaches it: no crossing is between them.
  const float end_of_path = length_m < whole_m ? begin + (end - begin) * length_m / whole_m : end;
  return {chord,
          alongPath(chord.column, path_->aside),
          alongPath(chord.row, path_->aside),
          begin,
          end_of_path,
          first_m,
          length_m};
}

inline RasterLine PathPosts::lineIn(int block) const {
  const Part part = partIn(block);
  const auto column = static_cast<double>(part.column.at(part.begin)),
             row = static_cast<double>(part.row.at(part.begin));
  return {column + part.chord.corner_column,
          row + part.chord.corner_row,
          static_cast<double>(part.column.at(part.end)) - column,
          static_cast<double>(part.row.at(part.end)) - row,
          part.first_m,
          part.length_m};
}

EMSCAPE_SIMD_CLONES void PathPosts::read(int block) {
  if (read_for_[block] == number_) return;
  read_for_[block] = number_;
  const SectorPosts& posts = obstacles_.posts;
  const Part part = partIn(block);
  float *const range_m = range_m_.data() + block * kOfBlock, *const height_m =
                                                                 height_m_.data() + block * kOfBlock;
  // Chords meet within rounding: the first block of one begins a little earlier.
  const float overlap = block > 0 && block % posts.blocksPerChord() == 0 ? 1e-4f : 0;
  const Lines columns(part.column.at(part.begin), part.column.at(part.end), overlap);
  const Lines rows(part.row.at(part.begin), part.row.at(part.end), overlap);
  is_left_ = is_left_ || columns.count + rows.count > kCrossings;
  columns_[block] = columns.count;
  readCrossingsOfBlock({columns, rows, part.chord.corner_msl_m, terrain_.rowPosts(), terrain_.base_msl_m(),
                        part.first_m, part.length_m},
                       range_m, height_m);
  used_[block] = kCrossings;
  if (isNear(block) || areRaised()) {
    const auto add = [&](int place, float at_m, float of_chord) {
      used_[block] = kOfBlock;
      range_m[kCrossings + place] = at_m;
      height_m[kCrossings + place] = heightAt(part, of_chord);
    };
    if (isNear(block)) {
      const int first = block * kBlock, end = std::min(obstacles_.ground.near_count, path_->before + 1);
      for (int post = std::max(first, 1); post < std::min(first + kBlock, end); ++post)
        add(post - first, posts.range_m()[post], posts.part()[post]);
    } else {  // profiles have posts at the beginnings of chords
      const float next_m = std::ceil(part.first_m / chord_m_) * chord_m_;
      if (next_m < part.first_m + part.length_m) add(0, next_m, part.at(next_m));
    }
  }
  if (terrain_.slack_m()[block] < HUGE_VALF) return;
  for (int i = 0; i < used(block); ++i) is_left_ = is_left_ || std::isnan(height_m[i]);
}

EMSCAPE_SIMD_CLONES void PathPosts::raise(int block) {
  raised_for_[block] = number_;
  doubtful_[block] =
      cover_->raise(lineIn(block), columns_[block], kCrossings, used_[block], path_->distance_m, beside_m_,
                    terrain_.base_msl_m(), range_m(block), height_m_.data() + block * kOfBlock);
}

EMSCAPE_SIMD_CLONES void PathPosts::readClutterPosts(int block) {
  const GroundPosts& ground = obstacles_.ground;
  const float* const last_m = obstacles_.posts.last_m();
  if (clutter_m_.empty()) {
    for (int n = 0; n < ground.clutterPosts(); ++n) {
      const double at_m = ground.clutterPost_m(n, path_->exact_distance_m);
      if (isClutterAt(at_m, path_->exact_distance_m)) clutter_m_.push_back(static_cast<float>(at_m));
    }
  }
  constexpr int kMost = (kMostClutterPosts + kOfBlock - 1) / kOfBlock * kOfBlock;
  float range_m[kMost], height_m[kMost];
  int count = 0;
  for (const float here_m : clutter_m_) {
    const bool is_before = block > 0 && !(here_m > last_m[block - 1]);
    const bool is_beyond = block + 1 < path_->blocks && here_m > last_m[block];
    range_m[count] = here_m;
    count += is_before || is_beyond ? 0 : 1;
  }
  const Part part = partIn(block);
  const Parabola<float> column = part.column, row = part.row;
  const float* const corner_msl_m = part.chord.corner_msl_m;
  const int row_posts = terrain_.rowPosts();
  const float base_msl_m = terrain_.base_msl_m();
  for (int i = count; i % kOfBlock != 0; ++i) range_m[i] = height_m[i] = 0;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float at = part.at(range_m[i]);
    height_m[i] = bilinearHeight(corner_msl_m, row_posts, column.at(at), row.at(at)) - base_msl_m;
  }
  for (int begin = 0; begin < count; begin += kOfBlock) {
    const int posts = std::min(count - begin, kOfBlock);
    const unsigned doubtful = cover_->raise(lineIn(block), 0, 0, posts, path_->distance_m, beside_m_,
                                            base_msl_m, range_m + begin, height_m + begin);
    for (int i = 0; i < posts; ++i) {
      is_left_ = is_left_ || std::isnan(height_m[begin + i]);
      clutter_posts_.push_back({block, range_m[begin + i], height_m[begin + i], (doubtful >> i & 1) != 0});
    }
  }
}

}  // namespace emscape::emfield
