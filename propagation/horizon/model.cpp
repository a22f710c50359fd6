#include "propagation/horizon/model.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "propagation/horizon/horizon.h"

namespace emscape::propagation {

std::vector<std::string> horizonPathWarnings(const PathInputs& inputs) {
  if (std::max(inputs.site.height_msl_m, inputs.extent.highest_msl_m) <= kLinearRefractivityHeight_m)
    return {};
  return {fmt::format("takes refractivity as linear in height, which does not hold above {:.0f} m",
                      kLinearRefractivityHeight_m)};
}

Explanation explainHorizon(const PathInputs& inputs, PathColumn& path) {
  // Slopes in single precision, as in the field.
  const HorizonGeometry<float> geometry{static_cast<float>(inputs.site.height_msl_m),
                                        static_cast<float>(inputs.site.effective_earth_radius_m)};
  const TerrainProfile& profile = path.column().profile;
  std::vector<RangeTerms<float>> ranges;
  for (int i = 0; i < profile.count; ++i) ranges.push_back(geometry.termsAt(profile.range_m[i]));
  std::vector<float> slopes(ranges.size());
  grazingSlopes(geometry, profile.height_msl_m, ranges.data(), profile.count, slopes.data());
  const int before = profile.count - 2;
  const bool is_lit =
      before == 0 || path.column().height_msl_m[0] >= geometry.heightOn(slopes[before], ranges.back());
  Explanation explanation;
  explanation.why = is_lit ? "no obstacle above the ray: free space"
                           : "an obstacle above the ray: no field behind it (no diffraction)";
  if (!is_lit) {
    explanation.add("shadow", "shadow of terrain and earth", std::numeric_limits<double>::infinity());
  }
  return explanation;
}

}  // namespace emscape::propagation
