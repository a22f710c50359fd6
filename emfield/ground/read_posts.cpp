#include "emfield/ground/read_posts.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"
#include "emfield/ground/chord_crossings.h"

namespace emscape::emfield {
namespace {

/// Heights in the chord's raster. @return false if one is NaN
EMSCAPE_SIMD_CLONES bool readInRaster(const RasterChord& in, const double* ranges_m, int count,
                                      float* height_msl_m) {
  const RasterChord chord = in;  // stores into height_msl_m do not change it
  float unknown = 0;
#pragma omp simd reduction(+ : unknown)
  for (int i = 0; i < count; ++i) {
    const float here = chord.heightAt(ranges_m[i]);
    height_msl_m[i] = here;
    unknown += here - here;
  }
  return !std::isnan(unknown);
}

/// Where the posts of a path are stored.
struct PostStore {
  double* range_m;
  float* height_msl_m;
};

/// The crossings of a chord, in their order. @return false if one is beside a void
EMSCAPE_SIMD_CLONES bool readCrossings(const ChordCrossings& of, double begin_m, double chord_m,
                                       double receivers_m, const PostStore& to) {
  constexpr int kLanes = 16;            // all computed, so that no loop has a remainder
  const ChordCrossings crossings = of;  // stores do not change it
  double* const range_m = to.range_m - 1;
  float* const height_msl_m = to.height_msl_m - 1;
  const int count = crossings.count();
  for (int i = 1; i <= count; ++i) range_m[i] = -1;
  const auto readLines = [&](int lines, const auto& at) {
    for (int first = 0; first < lines; first += kLanes) {
      double lane_range_m[kLanes];
      float part[kLanes], lane_msl_m[kLanes];
      int place[kLanes];
#pragma omp simd
      for (int n = 0; n < kLanes; ++n) {
        const Crossing crossing = at(first + n < lines ? first + n : lines - 1);
        part[n] = crossing.part;
        lane_msl_m[n] = crossing.height_msl_m;
        place[n] = crossing.place;
      }
#pragma omp simd
      for (int n = 0; n < kLanes; ++n) {
        lane_range_m[n] = crossingRange_m(begin_m, chord_m, part[n], receivers_m);
      }
      for (int n = 0; n < std::min(kLanes, lines - first); ++n) {
        range_m[place[n]] = lane_range_m[n];
        height_msl_m[place[n]] = lane_msl_m[n];
      }
    }
  };
  const int columns = crossings.columns.count, rows = crossings.rows.count;
  if (crossings.columns.is_straight) {
    readLines(columns, [&](int n) { return crossings.atColumn<true>(n); });
  } else {
    readLines(columns, [&](int n) { return crossings.atColumn(n); });
  }
  if (crossings.rows.is_straight) {
    readLines(rows, [&](int n) { return crossings.atRow<true>(n); });
  } else {
    readLines(rows, [&](int n) { return crossings.atRow(n); });
  }
  int empty = 0;
#pragma omp simd reduction(+ : empty)
  for (int i = 1; i <= count; ++i) empty += range_m[i] < 0 ? 1 : 0;
  for (int i = 1; empty > 0 && i <= count; ++i) {  // at posts of the raster
    if (range_m[i] >= 0) continue;
    --empty;
    range_m[i] = i > 1 ? range_m[i - 1] : crossingRange_m(begin_m, chord_m, 0, receivers_m);
    height_msl_m[i] = i > 1
                          ? height_msl_m[i - 1]
                          : bilinearHeight(crossings.corner_msl_m, crossings.row_posts,
                                           crossings.columns.coordinate.c[0], crossings.rows.coordinate.c[0]);
  }
  float unknown = 0;
#pragma omp simd reduction(+ : unknown)
  for (int i = 1; i <= count; ++i) unknown += height_msl_m[i] - height_msl_m[i];
  return !std::isnan(unknown);
}

/// Puts regular posts in order with others that are stored behind the places for them.
/// @param count, others  numbers of posts
void insert(const double* range_m, const float* height_msl_m, int count, int others, const PostStore& to) {
  for (int i = 0, other = count; i < count;) {
    const int at = i + other - count;
    const bool is_other = other < count + others && to.range_m[other] < range_m[i];
    to.range_m[at] = is_other ? to.range_m[other] : range_m[i];
    to.height_msl_m[at] = is_other ? to.height_msl_m[other] : height_msl_m[i];
    ++(is_other ? other : i);
  }
}

}  // namespace

void readPostsCpu(const Station& station, const GroundPosts& ground, const FastInverse& path, int count,
                  float* height_msl_m) {
  if (ground.is_smooth) {
    std::fill_n(height_msl_m, count, 0.0f);
    return;
  }
  TerrainWalk walk(station, ground.terrain, path);
  const double* const ranges_m = ground.ranges_m;
  for (int begin = 0; begin < count;) {
    const TerrainChord& chord = walk.chordAt(ranges_m[begin]);
    const int beyond = ground.lastBefore(walk.endOfChord_m(ranges_m[begin])) + 1;
    const int end = std::clamp(beyond, begin + 1, count);
    if (chord.in_raster.corner_msl_m == nullptr ||
        !readInRaster(chord.in_raster, ranges_m + begin, end - begin, height_msl_m + begin)) {
      for (int i = begin; i < end; ++i) height_msl_m[i] = chord.heightAt(ground.terrain, ranges_m[i]);
    }
    begin = end;
  }
}

int readProfileCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                   bool at_crossings, double* range_m, float* height_msl_m) {
  constexpr int kMaxNear = 128;  // of posts at a tenth of the range from 2 m to 3 spacings
  const int regular = ground.lastBefore(path.distance_m) + 1;
  if (ground.is_smooth || !at_crossings) {
    readPostsCpu(station, ground, path, regular, height_msl_m);
    std::copy_n(ground.ranges_m, regular, range_m);
    return regular;
  }
  TerrainWalk walk(station, ground.terrain, path);
  const double chord_m = walk.chord_m();
  int count = 0;
  const auto add = [&](const TerrainChord& chord, double at_m) {
    range_m[count] = at_m;
    height_msl_m[count++] = chord.heightAt(ground.terrain, at_m);
  };
  for (int index = 0; index < walk.chords(); ++index) {
    const TerrainChord& chord = walk.chord(index);
    const double begin_m = index * chord_m;
    const int end = index + 1 < walk.chords() ? ground.lastBefore(begin_m + chord_m) + 1 : regular;
    add(chord, begin_m);
    if (chord.in_raster.corner_msl_m != nullptr) {
      const ChordCrossings crossings(chord.in_raster);
      const int near = index > 0 ? 0 : std::clamp(ground.near_count, 1, std::min(end, kMaxNear)) - 1;
      float near_msl_m[kMaxNear];
      if (crossings.count() <= ground.maxCrossings(chord_m) &&
          readCrossings(crossings, begin_m, chord_m, path.distance_m,
                        {range_m + count + near, height_msl_m + count + near}) &&
          readInRaster(chord.in_raster, ground.ranges_m + 1, near, near_msl_m)) {
        insert(ground.ranges_m + 1, near_msl_m, near, crossings.count(),
               {range_m + count, height_msl_m + count});
        count += near + crossings.count();
        continue;
      }
    }
    for (int i = ground.lastBefore(begin_m) + 1; i < end; ++i) {
      if (ground.ranges_m[i] > begin_m) add(chord, ground.ranges_m[i]);
    }
  }
  return count;
}

EMSCAPE_SIMD_CLONES float grazingSlopeCpu(const propagation::HorizonGeometry<float>& geometry,
                                          const float* height_msl_m,
                                          const propagation::RangeTerms<float>* terms, int count) {
  float highest = -HUGE_VALF, unknown = 0;
#pragma omp simd reduction(max : highest) reduction(+ : unknown)
  for (int i = 0; i < count; ++i) {
    const float height = height_msl_m[i], slope = geometry.slopeTo(height, terms[i]);
    highest = slope > highest ? slope : highest;
    unknown += height - height;
  }
  return highest + unknown;
}

}  // namespace emscape::emfield
