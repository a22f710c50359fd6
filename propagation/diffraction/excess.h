/// Excess of the model `diffraction` over columns.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/column.h"
#include "propagation/diffraction/profile_posts.h"

namespace emscape::propagation {

/// Delta-Bullington over the column's own profile, several heights at a time.
struct DiffractionExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kOnEffectiveEarth = true;
  static constexpr bool kInParts = false;
  static constexpr bool kReadsCrossings = true;

  DiffractionModel<float> model;
  float tx_msl_m = 0;

  /// @param excess_db  one per voxel; NaN over missing terrain
  /// @accuracy within 0.002 dB of deltaBullington in double over the same profile
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                 float* excess_db) const {
#ifdef __CUDA_ARCH__
    return fillInBlocks(column, scratch, excess_db);
#else
    return fillCpu(column, scratch, excess_db);
#endif
  }

 private:
  /// By vector instructions.
  unsigned fillCpu(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const;
#ifdef __CUDACC__
  EMSCAPE_HD unsigned fillInBlocks(const ExcessColumn& column, const ExcessScratch& scratch,
                                   float* excess_db) const {
    constexpr int kReceivers = kDiffractionReceivers;
    int k = 0;
    if (column.profile.count > 1) {
      const ProfilePosts posts(column.profile, double(model.half_curvature), scratch.post_numbers,
                               scratch.post_numbers + scratch.posts);
      DiffractionColumn<float, ProfilePosts> receivers(model, posts, tx_msl_m);
      if (receivers.isUnknown()) {
        for (; k < column.count; ++k) excess_db[k] = NAN;
        return kMissingTerrain;
      }
      for (bool is_free = false; k < column.count && !is_free; k += kReceivers) {
        float rx_msl_m[kReceivers], loss_db[kReceivers];
        for (int j = 0; j < kReceivers; ++j) {
          rx_msl_m[j] = column.height_msl_m[k + j < column.count ? k + j : column.count - 1];
        }
        is_free = receivers.losses(rx_msl_m, loss_db);
        for (int j = 0; j < kReceivers && k + j < column.count; ++j) excess_db[k + j] = loss_db[j];
      }
    }
    for (; k < column.count; ++k) excess_db[k] = 0;
    return 0;
  }
#endif
};

}  // namespace emscape::propagation
