/// One terrain profile, for DiffractionColumn.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/diffraction/column.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

/// The posts of a profile, the last of which is below the receivers, with the maxima of their blocks.
class ProfilePosts {
 public:
  /// Number of blocks of a profile.
  static EMSCAPE_HD int blockCount(const TerrainProfile& profile) {
    return (profile.count + kDiffractionBlock - 2) / kDiffractionBlock;
  }

  /// @param profile  at least two posts; it and the arrays must outlive this object
  /// @param highest_msl_m, lowered_msl_m  blockCount(profile) elements each; overwritten
  EMSCAPE_HD ProfilePosts(const TerrainProfile& profile, double half_curvature, float* highest_msl_m,
                          float* lowered_msl_m)
      : profile_(profile), highest_msl_m_(highest_msl_m), lowered_msl_m_(lowered_msl_m) {
    const int last_block = (count() - 1) / kDiffractionBlock;
    const float curvature = float(half_curvature);
    for (int b = 0; b <= last_block; ++b) {
      float highest = -HUGE_VALF, lowered = -HUGE_VALF;
      for (int i = b * kDiffractionBlock; i < (b + 1) * kDiffractionBlock && i < count(); ++i) {
        const float height = profile.height_msl_m[i], range = float(profile.range_m[i]);
        const float here = height - curvature * range * range;
        highest = height > highest ? height : highest;
        lowered = here > lowered ? here : lowered;
      }
      highest_msl_m[b] = highest;
      lowered_msl_m[b] = lowered;
    }
    for (int i = 1; i < last_block * kDiffractionBlock; ++i) before_last_.add(profile, i);
  }

  EMSCAPE_HD int count() const { return profile_.count - 1; }
  EMSCAPE_HD double range_m(int i) const { return profile_.range_m[i]; }
  EMSCAPE_HD float height_msl_m(int i) const { return profile_.height_msl_m[i]; }
  EMSCAPE_HD float highest_msl_m(int block) const { return highest_msl_m_[block]; }
  EMSCAPE_HD float lowered_msl_m(int block) const { return lowered_msl_m_[block]; }
  /// Sums before the last block, the only ones that DiffractionColumn reads.
  EMSCAPE_HD TerrainSums sumsBefore(int) const { return before_last_; }
  EMSCAPE_HD double distance_m() const { return profile_.range_m[count()]; }
  EMSCAPE_HD float ground_msl_m() const { return profile_.height_msl_m[count()]; }
  EMSCAPE_HD double sea_m() const {
    return lengthOverSea_m(
        profile_.count, [this](int i) { return profile_.range_m[i]; },
        [this](int i) { return profile_.height_msl_m[i]; });
  }
  EMSCAPE_HD int lastBefore(double range_m) const {
    int begin = 0, end = count();  // the first that is not nearer
    while (begin < end) {
      const int middle = (begin + end) / 2;
      if (profile_.range_m[middle] < range_m) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    return begin > 0 ? begin - 1 : 0;
  }

 private:
  TerrainProfile profile_;
  const float *highest_msl_m_, *lowered_msl_m_;  ///< per block
  TerrainSums before_last_;
};

}  // namespace emscape::propagation
