/// A value that a model chooses automatically, for reports.
#pragma once

#include <string>

namespace emscape::propagation {

struct ModelChoice {
  std::string name;  ///< "range step"
  std::string text;  ///< value with unit, and the reason: "200 m: ..."
};

}  // namespace emscape::propagation
