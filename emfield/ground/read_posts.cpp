#include "emfield/ground/read_posts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#if defined(__GNUC__) && defined(__x86_64__)
#include <immintrin.h>
#endif

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

/// Crossings in the order of their parts.
struct Crossings {
  float *part, *height_msl_m;
};

/// Memory of a thread for one chord.
struct ChordMemory {
  Crossings columns{}, rows{}, all{};
  std::vector<char> is_column;  ///< per place: whether a column or a row is crossed there

  /// @param count  of all arrays
  void reset(int count) {
    const auto size = static_cast<std::size_t>(count);
    if (numbers_.size() < 6 * size) numbers_.resize(6 * size);
    float* next = numbers_.data();
    for (Crossings* const crossings : {&columns, &rows, &all}) {
      *crossings = {next, next + size};
      next += 2 * size;
    }
    is_column.assign(size, 0);
  }

 private:
  std::vector<float> numbers_;
};

/// Puts the crossings of a chord with columns and rows in one order. @param count  of both
void merge(const ChordMemory& of, int count) {
  for (int i = 0, column = 0; i < count; ++i) {
    const bool is_column = of.is_column[static_cast<std::size_t>(i)] != 0;
    const Crossings& from = is_column ? of.columns : of.rows;
    const int next = is_column ? column++ : i - column;
    of.all.part[i] = from.part[next];
    of.all.height_msl_m[i] = from.height_msl_m[next];
  }
}

#if defined(__GNUC__) && defined(__x86_64__)
/// The same, 16 at a time: a third of the time.
__attribute__((target("avx512f,popcnt"))) void mergeAvx512(const ChordMemory& of, int count) {
  for (int i = 0, column = 0; i < count; i += 16) {
    const __m512i is_column = _mm512_maskz_cvtepi8_epi32(
        0xffff, _mm_loadu_si128(reinterpret_cast<const __m128i*>(of.is_column.data() + i)));
    const unsigned here = count - i < 16 ? (1u << (count - i)) - 1 : 0xffffu;
    const auto columns = static_cast<__mmask16>(_mm512_test_epi32_mask(is_column, is_column) & here);
    const auto rows = static_cast<__mmask16>(here & ~columns);
    const int row = i - column;
    __m512 part = _mm512_maskz_expandloadu_ps(columns, of.columns.part + column);
    part = _mm512_mask_expandloadu_ps(part, rows, of.rows.part + row);
    __m512 height_msl_m = _mm512_maskz_expandloadu_ps(columns, of.columns.height_msl_m + column);
    height_msl_m = _mm512_mask_expandloadu_ps(height_msl_m, rows, of.rows.height_msl_m + row);
    _mm512_storeu_ps(of.all.part + i, part);
    _mm512_storeu_ps(of.all.height_msl_m + i, height_msl_m);
    column += __builtin_popcount(columns);
  }
}
const auto mergeCrossings = __builtin_cpu_supports("avx512f") ? mergeAvx512 : merge;
#else
constexpr auto mergeCrossings = merge;
#endif

/// The crossings of a chord, in their order. @return false if one is beside a void
EMSCAPE_SIMD_CLONES bool readCrossings(const ChordCrossings& of, double begin_m, double chord_m,
                                       double receivers_m, ChordMemory& memory, const PostStore& to) {
  constexpr int kLanes = 16;            // all computed, so that no loop has a remainder
  const ChordCrossings crossings = of;  // stores do not change it
  const int count = crossings.count(), columns = crossings.columns.count, rows = crossings.rows.count;
  memory.reset(count + kLanes);
  char* const is_column = memory.is_column.data();
  const auto readLines = [&](int lines, const Crossings& into, const auto& at, const auto& usePlaces) {
    float *const parts = into.part, *const heights_msl_m = into.height_msl_m;
    for (int first = 0; first < lines; first += kLanes) {
      int place[kLanes];
#pragma omp simd
      for (int n = 0; n < kLanes; ++n) {
        const Crossing crossing = at(first + n < lines ? first + n : lines - 1);
        parts[first + n] = crossing.part;
        heights_msl_m[first + n] = crossing.height_msl_m;
        place[n] = crossing.place;
      }
      usePlaces(place, std::min(kLanes, lines - first));
    }
  };
  const auto ofColumns = [&](const int* place, int places) {
    for (int n = 0; n < places; ++n) is_column[place[n] - 1] = 1;
  };
  const auto ofRows = [](const int*, int) {};  // the rest
  if (crossings.columns.is_straight) {
    readLines(
        columns, memory.columns, [&](int n) { return crossings.atColumn<true>(n); }, ofColumns);
  } else {
    readLines(
        columns, memory.columns, [&](int n) { return crossings.atColumn(n); }, ofColumns);
  }
  if (crossings.rows.is_straight) {
    readLines(
        rows, memory.rows, [&](int n) { return crossings.atRow<true>(n); }, ofRows);
  } else {
    readLines(
        rows, memory.rows, [&](int n) { return crossings.atRow(n); }, ofRows);
  }
  int places = 0;
#pragma omp simd reduction(+ : places)
  for (int i = 0; i < count; ++i) places += is_column[i];
  if (places < columns) {  // at posts of the raster two may have the same place
    std::fill_n(is_column, count, 0);
    for (int n = 0, place = 0; n < columns; ++n) {
      place = std::max(crossings.atColumn(n).place, place + 1);
      is_column[place - 1] = 1;
    }
  }
  mergeCrossings(memory, count);
  float unknown = 0;
  const float *const parts = memory.all.part, *const heights_msl_m = memory.all.height_msl_m;
  double* const range_m = to.range_m;
  float* const to_msl_m = to.height_msl_m;
#pragma omp simd reduction(+ : unknown)
  for (int i = 0; i < count; ++i) {
    range_m[i] = crossingRange_m(begin_m, chord_m, parts[i], receivers_m);
    const float here = heights_msl_m[i];
    to_msl_m[i] = here;
    unknown += here - here;
  }
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

void readPostsCpu(const Station& station, const GroundPosts& ground, const FastInverse& path, int first,
                  int count, float* height_msl_m) {
  if (ground.is_smooth) {
    std::fill(height_msl_m + first, height_msl_m + count, 0.0f);
    return;
  }
  TerrainWalk walk(station, ground.terrain, path);
  const double* const ranges_m = ground.ranges_m;
  for (int begin = first; begin < count;) {
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
  thread_local ChordMemory memory;
  constexpr int kMaxNear = 128;  // of posts at a tenth of the range from 2 m to 3 spacings
  const int regular = ground.lastBefore(path.distance_m) + 1;
  if (ground.is_smooth || !at_crossings) {
    readPostsCpu(station, ground, path, 0, regular, height_msl_m);
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
          readCrossings(crossings, begin_m, chord_m, path.distance_m, memory,
                        {range_m + count + near, height_msl_m + count + near})) {
        if (!readInRaster(chord.in_raster, ground.ranges_m + 1, near, near_msl_m)) {  // beside a void
          for (int i = 0; i < near; ++i)
            near_msl_m[i] = chord.heightAt(ground.terrain, ground.ranges_m[1 + i]);
        }
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
