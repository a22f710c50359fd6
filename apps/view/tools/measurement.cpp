#include "apps/view/tools/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/display_units.h"
#include "emfield/link/path_report.h"
#include "emscape/base/units.h"

namespace emscape::view {
namespace {

GeodesicInverse geodesic(const emfield::PathEnd& from, const emfield::PathEnd& to) {
  return geodesicInverse(from.position.latitude_deg, from.position.longitude_deg, to.position.latitude_deg,
                         to.position.longitude_deg);
}

}  // namespace

std::string verdictOf(const Measurement& measurement, Units units) {
  const std::vector<emfield::PathObstacle>& obstacles = measurement.path.obstacles;
  // The one that the profile's plot marks.
  const auto decisive =
      std::find_if(obstacles.begin(), obstacles.end(), [](const auto& obstacle) { return obstacle.decides; });
  if (decisive == obstacles.end()) return "In sight.";
  const char* const thing = decisive->is_earth_bulge ? "the earth's bulge" : "the terrain";
  const bool is_above = decisive->clearance_m < 0;
  return fmt::format("{}: {} at {} is {} {} the line.", is_above ? "Not in sight" : "In sight", thing,
                     distanceText(decisive->range_m, units),
                     heightText(std::abs(decisive->clearance_m), units), is_above ? "above" : "below");
}

Measurement measure(const emfield::PathEnd& from, const emfield::PathEnd& to,
                    const propagation::Atmosphere& atmosphere, double frequency_hz,
                    const scenario::Terrain* terrain) {
  constexpr double kMinPath_m = 1;  // of a profile
  Measurement result;
  result.from = from;
  result.to = to;
  const GeodesicInverse forward = geodesic(from, to);
  result.distance_m = forward.distance_m;
  result.slant_m = length(toEcef(to.position) - toEcef(from.position));
  result.bearing_deg = radToDeg(forward.azimuth_rad);
  result.back_bearing_deg = radToDeg(geodesic(to, from).azimuth_rad);
  result.path.frequency_hz = frequency_hz;
  result.path.k_factor = atmosphere.k_factor;
  if (result.distance_m >= kMinPath_m) {
    result.path.profile = emfield::readPathProfile(from, to, atmosphere, terrain, true);
    result.path.obstacles = emfield::pathObstacles(result.path.profile, wavelength_m(frequency_hz));
    result.is_blocked = emfield::isBlocked(result.path);
  }
  return result;
}

}  // namespace emscape::view
