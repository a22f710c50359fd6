/// Terrain along a path, input of the models.
#pragma once

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// Terrain along a path: `count` posts, ranges strictly increasing from 0 at the transmitter.
struct TerrainProfile {
  const double* range_m = nullptr;
  const float* height_msl_m = nullptr;
  int count = 0;

  /// The part of the profile up to a post.
  EMSCAPE_HD TerrainProfile upTo(int last) const { return {range_m, height_msl_m, last + 1}; }
};

}  // namespace emscape::propagation
