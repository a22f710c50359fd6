/// Excess of free_space and horizon, which consists only of the atmospheric attenuation.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/column.h"

namespace emscape::propagation {

struct NoExcess {
  static constexpr bool kNeedsTerrain = false;
  static constexpr bool kInParts = false;

  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch&, float* excess_db) const {
    for (int k = 0; k < column.count; ++k) excess_db[k] = 0;
    return 0;
  }
};

}  // namespace emscape::propagation
