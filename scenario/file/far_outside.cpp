#include "scenario/file/far_outside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_mistakes.h"
#include "emscape/base/geodesy/geo_frame.h"

namespace emscape::scenario {
namespace {

/// Distance (m) of a position from a circle around the region; 0 within.
double outside_m(const Region& region, double latitude_deg, double longitude_deg) {
  const double radius_m = std::hypot(region.size_m.x, region.size_m.y) / 2;
  const double distance_m =
      geodesicInverse(region.origin.latitude_deg, region.origin.longitude_deg, latitude_deg, longitude_deg)
          .distance_m;
  return std::max(distance_m - radius_m, 0.0);
}

}  // namespace

std::string farOutsideText(const Region& region, const std::vector<GeodeticPosition>& positions) {
  double nearest_m = HUGE_VAL;
  const GeodeticPosition* nearest = nullptr;
  for (const GeodeticPosition& position : positions) {
    const double distance_m = outside_m(region, position.latitude_deg, position.longitude_deg);
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &position;
  }
  if (nearest == nullptr || nearest_m <= kFarOutside_m) return "";
  const double near_m = std::max(std::hypot(region.size_m.x, region.size_m.y), 2e5);
  const auto mistake = mistakeIn(nearest->latitude_deg, nearest->longitude_deg,
                                 [&](double latitude_deg, double longitude_deg) {
                                   return outside_m(region, latitude_deg, longitude_deg) <= near_m;
                                 });
  return fmt::format(
      "{} {:.0f} km outside the region{}",
      positions.size() == 1 ? "its position is" : "all its positions are at least", nearest_m / 1000,
      mistake ? fmt::format("; perhaps {}: latitude {:.5g}, longitude {:.5g} deg would be near it",
                            mistake->text, mistake->latitude_deg, mistake->longitude_deg)
              : "");
}

}  // namespace emscape::scenario
