/// Places over which a field is computed instead of in a region's voxels: maps at heights above ground or
/// sea.
#pragma once

#include <vector>

#include "emscape/base/unset_vector.h"

namespace emscape::emfield {

/// Zero of a surface's heights.
enum class HeightReference { ground, mean_sea_level };

/// width x height places, each with the same heights above it. A place whose latitude is NaN is left out: the
/// field there is masked, and costs nothing.
struct Surface {
  struct Place {
    double latitude_deg = 0, longitude_deg = 0;
  };
  int width = 0, height = 0;
  UnsetVector<Place> places;  ///< rows one after another
  HeightReference reference = HeightReference::ground;
  std::vector<double> heights_m;  ///< rising; above ground >= 0
  /// Lowest height of each place, added to heights_m; empty: 0. For searches with a bracket of its own at
  /// each place.
  std::vector<float> offsets_m;
};

}  // namespace emscape::emfield
