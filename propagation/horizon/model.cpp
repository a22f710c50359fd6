#include "propagation/horizon/model.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "propagation/horizon/horizon.h"

namespace emscape::propagation {

std::vector<std::string> horizonPathWarnings(const PathInputs& inputs) {
  if (inputs.emitter.atmosphere.refraction == RefractionProfile::exponential ||
      std::max(inputs.site.height_msl_m, inputs.extent.highest_msl_m) <= kLinearRefractivityHeight_m) {
    return {};
  }
  return {
      fmt::format("takes refractivity as linear in height, which does not hold above {:.0f} m; "
                  "'atmosphere: {{refraction: exponential}}' does",
                  kLinearRefractivityHeight_m)};
}

Explanation explainHorizon(const PathInputs& inputs, PathColumn& path) {
  // Slopes in single precision, as in the field.
  const HorizonGeometry<float> geometry{static_cast<float>(inputs.site.effective_height_msl_m),
                                        static_cast<float>(inputs.site.effective_earth_radius_m)};
  const TerrainProfile& profile = path.column().profile;
  const int last = profile.count - 1;  // below the point
  GrazingSlope<float> slope;
  for (int i = 1; i < last; ++i) {
    const float height_msl_m = profile.height_msl_m[i];
    slope.add(height_msl_m, geometry.slopeTo(height_msl_m, geometry.termsAt(profile.range_m[i])));
  }
  const bool is_lit =
      last < 2 || path.column().height_msl_m[0] >=
                      geometry.heightOn(slope.value(), geometry.termsAt(profile.range_m[last]));
  Explanation explanation;
  explanation.why = is_lit ? "no obstacle above the ray: free space"
                           : "an obstacle above the ray: no field behind it (no diffraction)";
  if (!is_lit) {
    explanation.add("shadow", "shadow of terrain and earth", std::numeric_limits<double>::infinity());
  }
  return explanation;
}

}  // namespace emscape::propagation
