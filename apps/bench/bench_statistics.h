/// Statistics of repeated measurements.
#pragma once

#include <algorithm>
#include <vector>

#include "apps/common/console.h"

namespace emscape::app {

/// @param values  at least one
inline double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// @param values  at least one
inline double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// {"median", "min", "max"}. @param values  at least one
inline Json spreadJson(const std::vector<double>& values) {
  return {{"median", medianOf(values)},
          {"min", *std::min_element(values.begin(), values.end())},
          {"max", *std::max_element(values.begin(), values.end())}};
}

}  // namespace emscape::app
