#include "propagation/parabolic_equation/air/path_air.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "emscape/base/units.h"
#include "propagation/parabolic_equation/air/ducts.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"

namespace emscape::propagation {
namespace {

using Position = RefractivityField::Position;

constexpr int kIntervals = 128;
constexpr double kReach = 1.25;
constexpr double kNearest_m = 100;

/// Great circles of a sphere are accurate enough for the positions of profiles.
double distance_m(const Position& a, const Position& b, double radius_m) {
  const double lat_a = degToRad(a.latitude_deg), lat_b = degToRad(b.latitude_deg);
  const double half_lat = std::sin((lat_b - lat_a) / 2);
  const double half_lon = std::sin(degToRad(b.longitude_deg - a.longitude_deg) / 2);
  const double square = half_lat * half_lat + std::cos(lat_a) * std::cos(lat_b) * half_lon * half_lon;
  return 2 * radius_m * std::asin(std::sqrt(std::min(square, 1.0)));
}

Position placeAt(const Position& from, double azimuth_rad, double range_m, double radius_m) {
  const double arc = range_m / radius_m, latitude = degToRad(from.latitude_deg);
  const double sin_latitude =
      std::sin(latitude) * std::cos(arc) + std::cos(latitude) * std::sin(arc) * std::cos(azimuth_rad);
  const double longitude = std::atan2(std::sin(azimuth_rad) * std::sin(arc) * std::cos(latitude),
                                      std::cos(arc) - std::sin(latitude) * sin_latitude);
  return {radToDeg(std::asin(std::clamp(sin_latitude, -1.0, 1.0))), from.longitude_deg + radToDeg(longitude)};
}

RefractivityAlongPath byPlace(const RefractivityField& field, const Site& site, double azimuth_rad) {
  const Position origin{site.latitude_deg, site.longitude_deg};
  double farthest_m = 0;
  for (const Position& position : field.positions) {
    farthest_m = std::max(farthest_m, distance_m(origin, position, site.earth_radius_m));
  }
  const double step_m = std::max(kReach * farthest_m, 1.0) / kIntervals;
  std::vector<double> ranges_m, weights(field.positions.size());
  std::vector<RefractivityProfile> profiles;
  for (int i = 0; i <= kIntervals; ++i) {
    ranges_m.push_back(i * step_m);
    const Position here = placeAt(origin, azimuth_rad, ranges_m.back(), site.earth_radius_m);
    for (std::size_t p = 0; p < weights.size(); ++p) {
      weights[p] =
          std::pow(std::max(distance_m(here, field.positions[p], site.earth_radius_m), kNearest_m), -2);
    }
    profiles.push_back(meanProfile(field.profiles, weights));
  }
  return {std::move(ranges_m), std::move(profiles)};
}

RefractivityAlongPath alongPath(const RefractivityField& field, const Site& site, double azimuth_rad) {
  const RefractivityAlongPath air = field.profiles.size() == 1 ? RefractivityAlongPath(field.profiles.front())
                                    : field.ranges_m.empty()
                                        ? byPlace(field, site, azimuth_rad)
                                        : RefractivityAlongPath(field.ranges_m, field.profiles);
  if (field.evaporation_duct_m == 0) return air;
  std::vector<RefractivityProfile> profiles;
  for (const RefractivityProfile& profile : air.profiles())
    profiles.push_back(withEvaporationDuct(profile, field.evaporation_duct_m));
  return {air.ranges_m(), std::move(profiles)};
}

}  // namespace

RefractivityAlongPath pathAir(const Atmosphere& atmosphere, const Site& site, double azimuth_rad) {
  if (atmosphere.refractivity) return alongPath(atmosphere.refractivity->air, site, azimuth_rad);
  return linearRefractivity(kFlatteningGradient_m / atmosphere.k_factor);
}

std::vector<RefractivityAlongPath> pathAirs(const Atmosphere& atmosphere, const Site& site,
                                            double azimuth_rad) {
  std::vector<RefractivityAlongPath> airs;
  if (atmosphere.refractivity) {
    for (const RefractivityField& member : atmosphere.refractivity->members) {
      airs.push_back(alongPath(member, site, azimuth_rad));
    }
  }
  if (airs.empty()) airs.push_back(pathAir(atmosphere, site, azimuth_rad));
  return airs;
}

RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air, const float* ground_msl_m,
                                          std::size_t count, double step_m) {
  double top_msl_m = 0;
  for (const RefractivityProfile& profile : air.profiles())
    top_msl_m = std::max(top_msl_m, evaporationDuctTop_msl_m(profile).value_or(0));
  const auto isLand = [&](std::size_t post) {
    return ground_msl_m[post] > 0 && double(ground_msl_m[post]) < top_msl_m;
  };
  std::set<double> ranges_m(air.ranges_m().begin(), air.ranges_m().end());
  bool is_any = false;
  for (std::size_t i = 0; i < count; ++i) {
    is_any = is_any || isLand(i);
    if (i > 0 && isLand(i) != isLand(i - 1)) ranges_m.insert({double(i - 1) * step_m, double(i) * step_m});
  }
  if (!is_any) return air;
  std::vector<RefractivityProfile> profiles;
  for (const double range_m : ranges_m) {
    const auto post = std::size_t(std::lround(std::clamp(range_m / step_m, 0.0, double(count - 1))));
    profiles.push_back(isLand(post) ? withoutEvaporationDuct(air.at(range_m)) : air.at(range_m));
  }
  return {{ranges_m.begin(), ranges_m.end()}, std::move(profiles)};
}

RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air) {
  std::vector<RefractivityProfile> profiles;
  for (const RefractivityProfile& profile : air.profiles())
    profiles.push_back(withoutEvaporationDuct(profile));
  return {air.ranges_m(), std::move(profiles)};
}

}  // namespace emscape::propagation
