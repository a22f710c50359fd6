#include "emfield/ground/read_posts.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"

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

}  // namespace

void readPostsCpu(const Station& station, const GroundPosts& ground, const FastInverse& path, int count,
                  float* height_msl_m) {
  readPostsBetweenCpu(station, ground, path, 0, count, height_msl_m);
}

void readPostsBetweenCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                         int first, int count, float* height_msl_m) {
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
