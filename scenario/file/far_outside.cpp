#include "scenario/file/far_outside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_mistakes.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/work.h"

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
    checkpoint();
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

std::string mistakenPlaceText(const Region& region, double latitude_deg, double longitude_deg) {
  const std::string text = farOutsideText(region, {{latitude_deg, longitude_deg, 0}});
  return text.find("; perhaps ") == std::string::npos ? "" : text;
}

std::string outsideHeightsText(const Snapshot& snapshot, const Terrain* terrain) {
  constexpr double kFar_m = 500;
  const Region& region = snapshot.scenario->region;
  const double lower_m = region.origin.height_msl_m, upper_m = lower_m + region.size_m.z;
  const double lowest_m = terrain == nullptr ? 0 : terrain->lowest_m();
  const std::string heights =
      fmt::format("the region's heights, {:g} to {:g} m above mean sea level", lower_m, upper_m);
  if (upper_m <= lowest_m)
    return fmt::format("{}, are below all ground, of {:.0f} m and more: no voxel has a field", heights,
                       lowest_m);
  double nearest_m = HUGE_VAL;
  std::string name;
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const double height_m = snapshot.emitters[e].height_msl_m;
    const double outside_m = std::max({lower_m - height_m, height_m - upper_m, 0.0});
    if (!snapshot.emitters[e].active || outside_m >= nearest_m) continue;
    nearest_m = outside_m;
    name = fmt::format("'{}' at {:.0f} m", snapshot.scenario->emitters[e].name, height_m);
  }
  if (name.empty() || nearest_m < kFar_m) return "";
  return fmt::format(
      "{}, have no emitter: the nearest is {}. 'origin.height_msl_m' is the lower face of the region",
      heights, name);
}

}  // namespace emscape::scenario
