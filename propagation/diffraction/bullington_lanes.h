/// Bullington's loss for vector loops.
#pragma once

#include <cmath>

#include "base/math/fast_math.h"
#include "propagation/diffraction/knife_edge.h"

namespace emscape::propagation {

/// bullingtonLossDb() without branches and library calls: see base/math/fast_math.h.
/// @accuracy within 5e-5 dB of that in double, up to nu = 100 and 500 km
inline float bullingtonLossInLoopDb(float nu, float distance_m) {
  constexpr float kOctavesPerNeper = 1.44269504f;
  const float above = nu - 0.1f;
  const float root = std::sqrt(above * above + 1);
  const float sum = above >= 0 ? root + above : 1 / (root - above);
  const float edge_db = 6.9f + 2 * fastRatioToDb(sum);
  const float loss_db =
      edge_db + (1 - fastExp2(edge_db * (-kOctavesPerNeper / 6))) * (10 + 2e-5f * distance_m);
  return nu <= kKnifeEdgeClear<float> ? 0.0f : loss_db;
}

}  // namespace emscape::propagation
