#include "emfield/excess/path_posts.h"

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

constexpr int kBlock = SectorPosts::kBlock;

using Floats = PathFloats;
using Ints = PathInts;

}  // namespace

PathPosts::PathPosts(const SectorObstacles& obstacles, const SectorTerrain& terrain, const BlockCover* cover,
                     double sine_of_latitude)
    : obstacles_(obstacles),
      terrain_(terrain),
      cover_(cover),
      longest_chord_m_(static_cast<float>(maxChord_m(sine_of_latitude))),
      slots_(kMaxSlots) {
  constexpr double kOf75Degrees = 0.965925826289068;
  longest_chord_beside_m_ = sine_of_latitude < kOf75Degrees ? 0.02f : 0.1f;  // see terrain_walk.h
}

void PathPosts::begin(PathLanes& paths) {
  constexpr float kRounding_m = 0.005f;
  paths_ = &paths;
  if (!areRaised()) return;
  const GroundPosts& ground = obstacles_.ground;
  mirrored_m_ = HUGE_VALF;
  nearest_end_m_ = *std::min_element(paths.last_m, paths.last_m + kPathLanes);
  for (int l = 0; l < kPathLanes; ++l) {
    chord_m_[l] = paths.distance_m[l] / (std::floor(paths.distance_m[l] / longest_chord_m_) + 1);
    const float part = chord_m_[l] / longest_chord_m_;  // the deviation grows by the cube
    beside_m_[l] = kRounding_m + longest_chord_beside_m_ * part * part * part;
    if (!ground.has_clutter) continue;
    mirrored_m_ = std::min(
        mirrored_m_, static_cast<float>(paths.exact_distance_m[l] - ground.ranges_m[ground.clutter_end]));
  }
  clutter_posts_.resize(ground.clutterPosts());
  for (int n = 0; n < ground.clutterPosts(); ++n) {
    for (int l = 0; l < kPathLanes; ++l) {
      const double path_m = paths.exact_distance_m[l], at_m = ground.clutterPost_m(n, path_m);
      clutter_posts_[n].range_m[l] = isClutterAt(at_m, path_m) ? static_cast<float>(at_m) : HUGE_VALF;
    }
    clutter_posts_[n].nearest_m =
        *std::min_element(clutter_posts_[n].range_m, clutter_posts_[n].range_m + kPathLanes);
  }
}

void PathPosts::leave(unsigned lanes) {
  for (int l = 0; l < kPathLanes; ++l) paths_->is_left[l] |= static_cast<int>(lanes >> l & 1);
}

inline void PathPosts::setPart(int block) {
  const SectorPosts& posts = obstacles_.posts;
  chord_ = &terrain_.chord(block / posts.blocksPerChord());
  part_.first_m = posts.first_m()[block];
  part_.whole_m = posts.last_m()[block] - part_.first_m;
  part_.begin = posts.firstPart()[block];
  part_.end = posts.lastPart()[block];
  // Chords meet within rounding: the first block of one begins a little earlier.
  part_.overlap = block > 0 && block % posts.blocksPerChord() == 0 ? 1e-4f : 0;
  const SectorChord chord = *chord_;
  const float first_m = part_.first_m, whole_m = part_.whole_m, begin = part_.begin, end = part_.end;
  const PathLanes& paths = *paths_;
#pragma omp simd
  for (int l = 0; l < kPathLanes; ++l) {
    const float to_last_m = paths.last_m[l] - first_m;
    const float within_m = to_last_m < whole_m ? to_last_m : whole_m;
    const float length_m = within_m > 0 ? within_m : 0;
    // Exactly where the next block begins, if the path reaches it: no crossing is between them.
    const float end_of_path = length_m < whole_m ? begin + (end - begin) * length_m / whole_m : end;
    const Parabola<float> column = alongPath(chord.column, paths.aside[l]),
                          row = alongPath(chord.row, paths.aside[l]);
    part_.length_m[l] = length_m;
    part_.column[l] = column.at(begin);
    part_.row[l] = row.at(begin);
    part_.columns[l] = column.at(end_of_path) - part_.column[l];
    part_.rows[l] = row.at(end_of_path) - part_.row[l];
  }
}

/// Reads the crossings with columns or with rows. By vectors: g++ makes branches of a loop.
template <bool kOnColumns>
inline void PathPosts::readCrossings() {
  const Floats zero{}, one = zero + 1;
  Floats begin, length, across_begin, across_length, length_m, last_m;
  load(kOnColumns ? part_.column : part_.row, begin);  // whose integers are the lines
  load(kOnColumns ? part_.columns : part_.rows, length);
  load(kOnColumns ? part_.row : part_.column, across_begin);
  load(kOnColumns ? part_.rows : part_.columns, across_length);
  load(part_.length_m, length_m);
  load(paths_->last_m, last_m);
  Ints is_forward, is_long;
  setAbove(length, zero, is_forward);
  setAbove(length_m, zero, is_long);
  Floats from;
  choose(is_forward, begin - part_.overlap, begin + part_.overlap, from);
  const Ints cell = __builtin_convertvector(from, Ints);
  const Ints last = __builtin_convertvector(begin + length, Ints);
  const Ints is_back = ~is_forward, counts = (((last - cell) ^ is_back) - is_back) & is_long;
  const Ints first = cell - is_forward, step = -2 * is_forward - 1;
  Floats per_length;
  choose(-counts >> 31, 1 / length, zero, per_length);
  int count[kPathLanes], most = 0;
  store(counts, count);
  for (const int of_path : count) most = std::max(most, of_path);
  if (most > kMaxCrossings) {
    leave((1u << kPathLanes) - 1);
    return;
  }
  const float* const corner_msl_m = chord_->corner_msl_m;
  const int to_next_post = kOnColumns ? terrain_.rowPosts() : 1;
  // Copies of a number to all lanes, which take a store each where the processor's vectors are narrower.
  const Ints none{}, next = none + 1, row_posts = none + terrain_.rowPosts();
  const Floats first_m = zero + part_.first_m, base_m = zero + terrain_.base_msl_m(),
               unused_m = zero - HUGE_VALF, halfway_m = last_m * (zero + 0.5f);
  Ints number = none, ahead = none;
  for (int n = 0; n < most; ++n, number += next, ahead += step) {
    Slot& slot = slots_[count_++];
    slot.on = kOnColumns ? PostOn::column : PostOn::row;
    const Ints is_used = (number - counts) >> 31, line = first + (ahead & is_used);
    const Floats at_line = __builtin_convertvector(line, Floats), along = (at_line - begin) * per_length;
    Ints is_before, is_after;
    setAbove(zero, along, is_before);
    setAbove(along, one, is_after);
    Floats part;
    choose(is_before, zero, along, part);
    choose(is_after, one, part, part);
    const Floats across = across_begin + part * across_length;
    const Ints across_cell = __builtin_convertvector(across, Ints);
    const Ints post = kOnColumns ? across_cell * row_posts + line : line * row_posts + across_cell;
    int place[kPathLanes];
    float near_of[kPathLanes], next_of[kPathLanes];
    store(post, place);
#pragma omp simd
    for (int l = 0; l < kPathLanes; ++l) {
      near_of[l] = corner_msl_m[place[l]];
      next_of[l] = corner_msl_m[place[l] + to_next_post];
    }
    Floats near_msl_m, next_msl_m;
    load(near_of, near_msl_m);
    load(next_of, next_msl_m);
    const Floats to_next = across - __builtin_convertvector(across_cell, Floats);
    const Floats above_m = near_msl_m + to_next * (next_msl_m - near_msl_m) - base_m;
    Floats range_m, height_m;
    choose(is_used, first_m + part * length_m, halfway_m, range_m);
    choose(is_used, above_m, unused_m, height_m);
    store(range_m, slot.range_m);
    store(height_m, slot.height_m);
    if (!areRaised()) continue;
    store(at_line, kOnColumns ? slot.column : slot.row);
    store(across, kOnColumns ? slot.row : slot.column);
  }
}

/// Reads the posts of the paths at one range each; infinite: none.
inline void PathPosts::readAt(const float* at_m) {
  Slot& slot = slots_[count_++];
  slot.on = PostOn::neither;
  const Floats zero{};
  Floats range_m, length_m, last_m, column, row, columns, rows;
  load(at_m, range_m);
  load(part_.length_m, length_m);
  load(paths_->last_m, last_m);
  load(part_.column, column);
  load(part_.row, row);
  load(part_.columns, columns);
  load(part_.rows, rows);
  const Floats infinite = zero + HUGE_VALF;
  Ints range_bits, infinite_bits, is_used;
  load(&range_m, range_bits);
  load(&infinite, infinite_bits);
  setAbove(length_m, zero, is_used);
  is_used &= (range_bits - infinite_bits) >> 31;
  Floats along;
  choose(is_used, (range_m - part_.first_m) / length_m, zero, along);
  const Floats x = column + along * columns, y = row + along * rows;
  const Ints i = __builtin_convertvector(x, Ints), j = __builtin_convertvector(y, Ints);
  int place[kPathLanes];
  float of_lanes[4][kPathLanes];
  const int row_posts = terrain_.rowPosts();
  store(j * row_posts + i, place);
  const float *const south_msl_m = chord_->corner_msl_m, *const north_msl_m = south_msl_m + row_posts;
#pragma omp simd
  for (int l = 0; l < kPathLanes; ++l) {
    of_lanes[0][l] = south_msl_m[place[l]];
    of_lanes[1][l] = south_msl_m[place[l] + 1];
    of_lanes[2][l] = north_msl_m[place[l]];
    of_lanes[3][l] = north_msl_m[place[l] + 1];
  }
  Floats west, east, west_north, east_north;
  load(of_lanes[0], west);
  load(of_lanes[1], east);
  load(of_lanes[2], west_north);
  load(of_lanes[3], east_north);
  const Floats to_east = x - __builtin_convertvector(i, Floats),
               to_north = y - __builtin_convertvector(j, Floats);
  const Floats south = west + to_east * (east - west),
               north = west_north + to_east * (east_north - west_north);
  const Floats above_m = south + to_north * (north - south) - terrain_.base_msl_m();
  Floats used_m, height_m;
  choose(is_used, range_m, last_m / 2, used_m);
  choose(is_used, above_m, zero - HUGE_VALF, height_m);
  store(used_m, slot.range_m);
  store(height_m, slot.height_m);
  store(x, slot.column);
  store(y, slot.row);
}

EMSCAPE_SIMD_CLONES void PathPosts::read(int block) {
  count_ = 0;
  setPart(block);
  readCrossings<true>();
  readCrossings<false>();
  const PathLanes& paths = *paths_;
  const GroundPosts& ground = obstacles_.ground;
  float at_m[kPathLanes];
  if (block * kBlock < ground.near_count) {
    const float* const range_m = obstacles_.posts.range_m();
    for (int post = std::max(block * kBlock, 1); post < std::min((block + 1) * kBlock, ground.near_count);
         ++post) {
      for (int l = 0; l < kPathLanes; ++l) at_m[l] = post <= paths.before[l] ? range_m[post] : HUGE_VALF;
      readAt(at_m);
    }
  } else if (areRaised()) {  // profiles have posts at the beginnings of chords
    bool is_any = false;
    for (int l = 0; l < kPathLanes; ++l) {
      const float next_m = std::ceil(part_.first_m / chord_m_[l]) * chord_m_[l];
      const bool is_here = next_m < part_.first_m + part_.length_m[l];
      at_m[l] = is_here ? next_m : HUGE_VALF;
      is_any = is_any || is_here;
    }
    if (is_any) readAt(at_m);
  }
  leaveUnknown(block, 0);
}

void PathPosts::leaveUnknown(int block, int first) {
  if (terrain_.slack_m()[block] < HUGE_VALF) return;
  for (int n = first; n < count_; ++n) {
    unsigned unknown = 0;
    for (int l = 0; l < kPathLanes; ++l) unknown |= (std::isnan(slots_[n].height_m[l]) ? 1u : 0u) << l;
    leave(unknown);
  }
}

EMSCAPE_SIMD_CLONES void PathPosts::readClutterPost(int block, const float* at_m) {
  readAt(at_m);
  leaveUnknown(block, count_ - 1);
}

unsigned PathPosts::raise(int n, unsigned lanes) {
  Slot& slot = slots_[n];
  return cover_->raise(
      {slot.on, slot.range_m, slot.column, slot.row, part_.columns, part_.rows, paths_->distance_m, beside_m_,
       chord_->corner_column, chord_->corner_row, terrain_.base_msl_m()},
      lanes, slot.height_m);
}

}  // namespace emscape::emfield
