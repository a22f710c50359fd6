#include "emfield/link/path_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "emscape/base/units.h"
#include "emscape/emfield/solver/steep_ground.h"

namespace emscape::emfield {
namespace {

std::string ofEnd(const PathEnd& end, double ground_msl_m, bool has_terrain) {
  return fmt::format("{:.5f}, {:.5f} deg; {:.1f} m above mean sea level (EGM96), {:.1f} m above {}",
                     end.position.latitude_deg, end.position.longitude_deg, end.height_msl_m,
                     end.height_msl_m - ground_msl_m,
                     has_terrain ? "ground" : "the smooth earth (no terrain)");
}

}  // namespace

void tellSteepGround(PathBudget& budget) {
  if (!budget.excess.steep) return;
  for (std::string& warning : steepGroundWarnings({{budget.emitter, {*budget.excess.steep}}}))
    budget.warnings.push_back(std::move(warning));
}

std::vector<ReportLine> geometryLines(const PathBudget& budget) {
  const PathGeometry& geometry = budget.geometry;
  const PathProfile& profile = budget.profile;
  return {
      {"emitter", ofEnd(profile.begin, geometry.begin_ground_msl_m, profile.has_terrain)},
      {"point", ofEnd(profile.end, geometry.end_ground_msl_m, profile.has_terrain)},
      {"range", fmt::format("{:.3f} km over the ground, {:.3f} km slant", profile.range_m / 1000,
                            geometry.slant_range_m / 1000)},
      {"azimuth", fmt::format("{:.3f} deg from true north", radToDeg(profile.azimuth_rad))},
      {"elevation of the ray",
       fmt::format("{:.3f} deg at the emitter ({:.3f} deg of the straight line)",
                   radToDeg(geometry.launch_elevation_rad), radToDeg(geometry.straight_elevation_rad))},
      {"effective earth",
       fmt::format("k = {:.4g}, radius {:.0f} km; a smooth one cuts off beyond {:.1f} km", budget.k_factor,
                   profile.effective_earth_radius_m / 1000, geometry.horizon_range_m / 1000)},
  };
}

std::string valueText(double value) {
  if (std::isinf(value)) return value < 0 ? "no field" : "infinite";
  return fmt::format("{:.2f}", std::abs(value) < 0.005 ? 0.0 : value);
}

std::string coverText(const PathObstacle& obstacle) {
  return fmt::format("ground cover {:.0f} m high ({})", obstacle.cover_m,
                     obstacle.cover_name.empty() ? "trees or buildings" : "'" + obstacle.cover_name + "'");
}

std::string remarkOf(const PathObstacle& obstacle) {
  std::string remark = obstacle.is_earth_bulge ? "earth's bulge"
                       : obstacle.cover_m > 0  ? coverText(obstacle)
                                               : "";
  if (obstacle.decides) {
    const char* const what = obstacle.clearanceInFresnelRadii() < 1 ? "decides" : "nearest to the ray";
    remark += (remark.empty() ? "" : "  ") + std::string(what);
  }
  return remark;
}

bool isBlocked(const PathBudget& budget) {
  return std::any_of(budget.obstacles.begin(), budget.obstacles.end(),
                     [](const PathObstacle& obstacle) { return obstacle.clearance_m < 0; });
}

}  // namespace emscape::emfield
