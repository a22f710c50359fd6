/// Excess of the model `two_ray` over columns.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/column.h"
#include "propagation/two_ray/two_ray.h"

namespace emscape::propagation {

/// In double precision: phases are path differences of many wavelengths.
struct TwoRayExcess {
  static constexpr bool kNeedsTerrain = false;
  static constexpr bool kInParts = false;

  TwoRayModel<double> model;  ///< of horizontal polarisation, if `both`
  TwoRayModel<double> vertical;
  bool both = false;  ///< slanted or circular: half of the power each
  double surface_msl_m = 0;
  double tx_msl_m = 0;

  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch&, float* excess_db) const {
    for (int k = 0; k < column.count; ++k) {
      const double rx_m = static_cast<double>(column.height_msl_m[k]) - surface_msl_m;
      const double tx_m = tx_msl_m - surface_msl_m;
      double excess = twoRayExcessDb(model, column.range_m, tx_m, rx_m);
      if (both) {
        const double other = twoRayExcessDb(vertical, column.range_m, tx_m, rx_m);
        excess = -10 * std::log10((std::pow(10.0, -excess / 10) + std::pow(10.0, -other / 10)) / 2);
      }
      excess_db[k] = static_cast<float>(excess);
    }
    return 0;
  }
};

}  // namespace emscape::propagation
