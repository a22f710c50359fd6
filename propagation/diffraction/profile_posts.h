/// One terrain profile, for DiffractionColumn.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/diffraction/column.h"
#include "propagation/diffraction/profile_summary.h"

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
      : profile_(profile), maxima_{highest_msl_m, lowered_msl_m} {
    before_last_ = summarize(profile, count(), float(half_curvature), maxima_);
  }

  EMSCAPE_HD int count() const { return profile_.count - 1; }
  EMSCAPE_HD double range_m(int i) const { return profile_.range_m[i]; }
  EMSCAPE_HD float height_msl_m(int i) const { return profile_.height_msl_m[i]; }
  EMSCAPE_HD float highest_msl_m(int block) const { return maxima_.highest_msl_m[block]; }
  EMSCAPE_HD float lowered_msl_m(int block) const { return maxima_.lowered_msl_m[block]; }
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
  BlockMaxima maxima_;
  TerrainSums before_last_;
};

}  // namespace emscape::propagation
