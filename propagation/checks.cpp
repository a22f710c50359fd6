#include "propagation/checks.h"

#include <fmt/core.h>

#include <algorithm>

namespace emscape::propagation {

std::vector<std::string> smoothHeightWarnings(const ModelLimit& limit, const PathInputs& inputs) {
  std::vector<std::string> messages;
  for (const double height_m : {inputs.site.height_msl_m - inputs.surface_msl_m,
                                std::max(inputs.extent.highest_msl_m - inputs.surface_msl_m, limit.min)}) {
    if (limit.holds(height_m)) continue;
    messages.push_back(fmt::format("{} {:.6g} m is outside {:.6g}..{:.6g} m: taken as the nearest of these",
                                   limit.parameter, height_m, limit.min, limit.max));
  }
  return messages;
}

}  // namespace emscape::propagation
