#include "propagation/diffraction/profile_summary.h"

#include <cmath>

#include "base/math/simd.h"

namespace emscape::propagation {

EMSCAPE_SIMD_CLONES TerrainSums summarizeCpu(const TerrainProfile& profile, int count, float half_curvature,
                                             const BlockMaxima& maxima) {
  const double* const range_m = profile.range_m;
  const float* const height_msl_m = profile.height_msl_m;
  const int last_block = (count - 1) / kDiffractionBlock;
  for (int b = 0; b <= last_block; ++b) {
    const int begin = b * kDiffractionBlock;
    const int end = begin + kDiffractionBlock < count ? begin + kDiffractionBlock : count;
    float highest = -HUGE_VALF, lowered = -HUGE_VALF;
#pragma omp simd reduction(max : highest, lowered)
    for (int i = begin; i < end; ++i) {
      const float height = height_msl_m[i], range = static_cast<float>(range_m[i]);
      const float here = height - half_curvature * range * range;
      highest = height > highest ? height : highest;
      lowered = here > lowered ? here : lowered;
    }
    maxima.highest_msl_m[b] = highest;
    maxima.lowered_msl_m[b] = lowered;
  }
  TerrainSums sums;
  double v1 = 0, v2 = 0;
  const double base = static_cast<double>(height_msl_m[0]);
#pragma omp simd reduction(+ : v1, v2)
  for (int i = 1; i < last_block * kDiffractionBlock; ++i) {
    const double before = range_m[i - 1], here = range_m[i];
    const double height_before = static_cast<double>(height_msl_m[i - 1]) - base;
    const double height = static_cast<double>(height_msl_m[i]) - base;
    v1 += (here - before) * (height + height_before);
    v2 += (here - before) * (height * (2 * here + before) + height_before * (here + 2 * before));
  }
  sums.v1 = v1;
  sums.v2 = v2;
  return sums;
}

}  // namespace emscape::propagation
