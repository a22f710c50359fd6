/// A value that a model chooses automatically, for reports.
#pragma once

#include <string>

namespace emscape::propagation {

struct ModelChoice {
  std::string name;   ///< "range step"
  std::string text;   ///< value with unit, and the reason: "200 m: ..."
  double time_s = 0;  ///< of a cost: processor time on one core, estimated
};

}  // namespace emscape::propagation
