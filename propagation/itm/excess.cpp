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

/// Heights of a profile at equal distances. Among the far posts, which are equally far apart, intervals are
/// found from the spacing.
inline void ItmExcess::spaceEvenlyInLanes(const TerrainProfile& profile, int intervals,
                                          float* heights_msl_m) {
  const double* const ranges_m = profile.range_m;
  const float* const posts_msl_m = profile.height_msl_m;
  const int last = profile.count - 1, last_even = last - 1;
  const double length_m = ranges_m[last], interval_m = length_m / intervals;
  const double step_m = last > 2 ? ranges_m[last_even] - ranges_m[last_even - 1] : 1, per_step = 1 / step_m;
  int even = 0;  // the first of the far posts
#pragma omp simd reduction(max : even)
  for (int i = 0; i < last_even; ++i) {
    const double even_m = ranges_m[last_even] - step_m * (last_even - i);
    const int beyond = std::fabs(even_m - ranges_m[i]) < 1e-5 * step_m ? 0 : i + 1;
    even = beyond > even ? beyond : even;
  }
  const double even_m = ranges_m[even];
  int first = 0;  // beyond the first of the far posts
  for (int after = 1; first <= intervals; ++first) {
    const double at_m = length_m * first / intervals;
    if (at_m > even_m) break;
    while (after < last && ranges_m[after] < at_m) ++after;
    const double before_m = ranges_m[after - 1];
    const auto part = static_cast<float>((at_m - before_m) / (ranges_m[after] - before_m));
    const float before = posts_msl_m[after - 1];
    heights_msl_m[first] = before + part * (posts_msl_m[after] - before);
  }
  const double last_even_m = ranges_m[last_even], last_step_m = length_m - last_even_m;
  const double per_last_m = last_step_m > 0 ? 1 / last_step_m : 0;
  const int even_steps = last_even - even;
#pragma omp simd
  for (int n = first; n <= intervals; ++n) {
    const double at_m = n * interval_m, steps = (at_m - even_m) * per_step;
    const int whole = static_cast<int>(steps);
    const bool is_last = whole >= even_steps;
    const int before = even + (is_last ? even_steps : whole);
    const auto part = static_cast<float>(is_last ? (at_m - last_even_m) * per_last_m : steps - whole);
    const float before_msl_m = posts_msl_m[before];
    heights_msl_m[n] = before_msl_m + part * (posts_msl_m[before + 1] - before_msl_m);
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
  ItmColumn statistics(even, linkTo(column, 0), scratch.post_numbers, scratch.post_numbers + scratch.posts);
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
