#include "emfield/columns/station.h"

#include <cmath>

namespace emscape::emfield {
namespace {

/// The CRPL exponential reference atmosphere of a refractivity at sea level: N falls by 7.32 exp(0.005577 N)
/// in the first kilometre, and exponentially with height (Bean and Thayer 1959, citation not checked).
Refraction exponentialRefraction(const Station& station, double sea_level_refractivity) {
  Refraction refraction;
  refraction.exponential = true;
  refraction.earth_radius_m = station.earth_radius_m;
  refraction.effective_earth_radius_m = station.effective_earth_radius_m;
  const double fall = 7.32 * std::exp(0.005577 * sea_level_refractivity);
  refraction.decay_per_m = std::log(sea_level_refractivity / (sea_level_refractivity - fall)) / 1000;
  refraction.gradient_per_m = 1e-6 * sea_level_refractivity * refraction.decay_per_m;
  refraction.grazing_ratio[0] = 1;
  for (int i = 1; i < Refraction::kNodes; ++i) {
    const double root = static_cast<double>(i) / (Refraction::kNodes - 1);
    const double height_m = static_cast<double>(Refraction::kHighest_m) * root * root;
    double image_m = height_m;
    for (int n = 0; n < 16; ++n) {
      image_m = refraction.imageHeight_m(0, height_m, refraction.horizon_m(image_m));
    }
    refraction.grazing_ratio[i] = static_cast<float>(image_m / height_m);
  }
  return refraction;
}

}  // namespace

Station makeStation(const GeodeticPosition& position, double height_msl_m, double k_factor) {
  Station station;
  station.latitude_deg = position.latitude_deg;
  station.longitude_deg = position.longitude_deg;
  station.geodesy = fastGeodesy(position.latitude_deg, position.longitude_deg);
  station.ecef_m = toEcef(position);
  station.height_msl_m = station.effective_height_msl_m = height_msl_m;
  station.earth_radius_m = std::sqrt(station.geodesy.meridian_radius_m * station.geodesy.prime_radius_m);
  station.effective_earth_radius_m = k_factor * station.earth_radius_m;
  return station;
}

Station makeStation(const GeodeticPosition& position, double height_msl_m,
                    const propagation::Atmosphere& atmosphere) {
  Station station = makeStation(position, height_msl_m, atmosphere.k_factor);
  if (atmosphere.refraction == propagation::RefractionProfile::exponential) {
    station.refraction = exponentialRefraction(station, atmosphere.sea_level_refractivity);
    station.effective_height_msl_m = station.refraction.grazingHeight_m(height_msl_m);
  }
  return station;
}

Vec3d lineTo(const Station& from, const GeodeticPosition& to) {
  const Vec3d line = toEcef(to) - from.ecef_m;
  return {dot(line, from.geodesy.east), dot(line, from.geodesy.north), dot(line, from.geodesy.station.up)};
}

}  // namespace emscape::emfield
