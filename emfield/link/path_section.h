/// The loss over range and height along a path, by any model, and the refractivity at the emitter.
#pragma once

#include <vector>

#include "emscape/emfield/link/path_profile.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

struct PathSection {
  std::vector<double> ranges_m;       ///< along the ground from the emitter, evenly spaced
  std::vector<double> heights_msl_m;  ///< evenly spaced, ascending
  std::vector<float> ground_msl_m;    ///< at the ranges
  /// Basic transmission loss (dB), heights x ranges, range fastest; NaN below the ground and where the model
  /// gives no field.
  std::vector<float> loss_db;
  /// Modified refractivity (M-units) at the emitter, by height.
  struct Level {
    double height_msl_m = 0, m_units = 0;
  };
  std::vector<Level> air;
};

/// The section along a path. It begins at the lowest ground; its height is 1.5 times that of the ends, the
/// ground and the trapping layers above it, at least 50 m.
/// @param ranges, heights  numbers of samples, each at least 2
/// @throws Error (bad_input) if the model refuses an input
PathSection pathSection(const scenario::Snapshot& snapshot, int emitter, propagation::PropagationModel model,
                        const PathProfile& profile, const scenario::Terrain* terrain, int ranges,
                        int heights);

}  // namespace emscape::emfield
