/// Points at which a field is computed instead of a region's voxels, for maps at heights above ground or sea.
#pragma once

#include <vector>

#include "emscape/base/unset_vector.h"

namespace emscape::emfield {

/// Datum of a surface's heights.
enum class HeightReference { ground, mean_sea_level };

/// width x height positions, each with the same heights above it. A position whose latitude is NaN is left
/// out: the field there is masked and not computed.
struct Surface {
  struct Position {
    double latitude_deg = 0, longitude_deg = 0;
  };
  int width = 0, height = 0;
  UnsetVector<Position> positions;  ///< rows one after another
  HeightReference reference = HeightReference::ground;
  std::vector<double> heights_m;  ///< ascending; above ground >= 0
  /// Offset added to heights_m at each position; empty: 0. For searches with a separate bracket at each
  /// position.
  std::vector<float> offsets_m;
};

}  // namespace emscape::emfield
