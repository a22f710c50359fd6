#include "propagation/itm/excess.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"
#include "propagation/itm/column.h"

namespace emscape::propagation {
namespace {

bool isItmUnknown(const TerrainProfile& profile) {
  const float* const heights_m = profile.height_msl_m;
  int unknown = 0;
#pragma omp simd reduction(| : unknown)
  for (int i = 0; i < profile.count; ++i) unknown |= heights_m[i] == heights_m[i] ? 0 : 1;
  return unknown != 0;
}

}  // namespace

/// Heights of a profile at equal distances, in parts of which the intervals are found first: among the far
/// posts, which are equally far apart, from the spacing.
inline void ItmExcess::spaceEvenlyInLanes(const TerrainProfile& profile, int intervals,
                                          float* heights_msl_m) {
  constexpr int kPart = 64;
  const double* const ranges_m = profile.range_m;
  const float* const posts_msl_m = profile.height_msl_m;
  const int last = profile.count - 1, last_even = last - 1;
  const double length_m = ranges_m[last];
  const double step_m = last > 2 ? ranges_m[last_even] - ranges_m[last_even - 1] : 1, per_step = 1 / step_m;
  int even = 0;  // the first of the far posts
#pragma omp simd reduction(max : even)
  for (int i = 0; i < last_even; ++i) {
    const double even_m = ranges_m[last_even] - step_m * (last_even - i);
    const int beyond = std::fabs(even_m - ranges_m[i]) < 0.01 * step_m ? 0 : i + 1;
    even = beyond > even ? beyond : even;
  }
  const double even_m = ranges_m[even];
  int after = 1;
  for (int first = 0; first <= intervals; first += kPart) {
    const int count = std::min(kPart, intervals + 1 - first);
    double at_m[kPart];
    int after_of[kPart];
#pragma omp simd
    for (int n = 0; n < count; ++n) at_m[n] = length_m * (first + n) / intervals;
    if (at_m[0] > even_m) {
#pragma omp simd
      for (int n = 0; n < count; ++n) {
        const int steps = even + static_cast<int>((at_m[n] - even_m) * per_step);
        const int nearest = steps < last_even ? steps + 1 : last_even;  // or one of its neighbours
        const int more = ranges_m[nearest] < at_m[n] ? 1 : 0, less = ranges_m[nearest - 1] < at_m[n] ? 0 : 1;
        after_of[n] = nearest + more - less;
      }
    } else {
      for (int n = 0; n < count; ++n) {
        while (after < last && ranges_m[after] < at_m[n]) ++after;
        after_of[n] = after;
      }
    }
#pragma omp simd
    for (int n = 0; n < count; ++n) {
      const double before_m = ranges_m[after_of[n] - 1];
      const auto part = static_cast<float>((at_m[n] - before_m) / (ranges_m[after_of[n]] - before_m));
      const float before = posts_msl_m[after_of[n] - 1];
      heights_msl_m[first + n] = before + part * (posts_msl_m[after_of[n]] - before);
    }
  }
}

EMSCAPE_SIMD_CLONES unsigned ItmExcess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                                   float* excess_db) const {
  const float path_weight = pathWeight(column);
  // Diffraction is only computed if it has a part in the result.
  const bool is_alone = path_weight == 1 && itmHeightWeight(heightAgl(column, column.count - 1)) == 1;
  if (!is_alone) {
    const unsigned warnings = diffraction(column, scratch, excess_db);
    if (warnings != 0 || path_weight == 0) return warnings;
  } else if (isItmUnknown(column.profile)) {
    std::fill_n(excess_db, column.count, NAN);
    return kMissingTerrain;
  }
  spaceEvenlyInLanes(column.profile, evenIntervals(column.profile), scratch.even_ground_msl_m);
  const ItmProfile<float> even = evenProfile(column, scratch);
  ItmColumn statistics(even, scratch.post_numbers, scratch.post_numbers + scratch.posts);
  float* const itm_db = scratch.other_db;
  int in_zone = 0;
  while (in_zone < column.count && isInZone(column, in_zone)) ++in_zone;
  const unsigned warnings = evaluate(column, in_zone, even, statistics, itm_db);
  if (is_alone) {
    if ((warnings & kItmRefused) != 0) diffraction(column, scratch, excess_db);
    for (int k = 0; k < column.count; ++k) {
      if (itm_db[k] == itm_db[k]) excess_db[k] = itm_db[k];
    }
  } else {
    for (int k = 0; k < in_zone; ++k) excess_db[k] = blended(column, k, path_weight, itm_db[k], excess_db[k]);
  }
  return warnings;
}

}  // namespace emscape::propagation
