/// Values of a profile for DiffractionColumn besides its posts: maxima of blocks, and sums over all
/// intervals.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

/// Posts per block.
constexpr int kDiffractionBlock = 16;

/// Arrays of one element per block.
struct BlockMaxima {
  float* highest_msl_m = nullptr;
  float* lowered_msl_m = nullptr;  ///< heights less the earth's bulge d^2 / (2 a)
};

/// Fills the maxima of the first `count` posts.
/// @return sums over the intervals that end before the last block; see TerrainSums
EMSCAPE_HD inline TerrainSums summarize(const TerrainProfile& profile, int count, float half_curvature,
                                        const BlockMaxima& maxima) {
  TerrainSums sums;
  const int last_block = (count - 1) / kDiffractionBlock;
  for (int b = 0; b <= last_block; ++b) {
    const int begin = b * kDiffractionBlock;
    const int end = begin + kDiffractionBlock < count ? begin + kDiffractionBlock : count;
    float highest = -HUGE_VALF, lowered = -HUGE_VALF;
    for (int i = begin; i < end; ++i) {
      const float height = profile.height_msl_m[i], range = float(profile.range_m[i]);
      const float here = height - half_curvature * range * range;
      highest = height > highest ? height : highest;
      lowered = here > lowered ? here : lowered;
    }
    maxima.highest_msl_m[b] = highest;
    maxima.lowered_msl_m[b] = lowered;
  }
  for (int i = 1; i < last_block * kDiffractionBlock; ++i) sums.add(profile, i);
  return sums;
}

}  // namespace emscape::propagation
