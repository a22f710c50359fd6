/// JSON of results: keys in their order, numbers that are not finite as null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace emscape::report {

using Json = nlohmann::ordered_json;

/// A finite number, or null.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
inline Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

}  // namespace emscape::report
