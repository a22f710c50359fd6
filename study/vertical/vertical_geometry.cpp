#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "emscape/study/vertical/vertical.h"

namespace emscape::study {

double VerticalDiagram::slantRange_m(double range_m, double height_msl_m) const {
  const double from = effective_earth_radius_m + station_msl_m, to = effective_earth_radius_m + height_msl_m;
  const double half_angle = range_m / effective_earth_radius_m / 2;
  return std::hypot(to - from, 2 * std::sqrt(from * to) * std::sin(half_angle));
}

double VerticalDiagram::elevation_deg(double range_m, double height_msl_m) const {
  const double angle = range_m / effective_earth_radius_m;
  const double to = effective_earth_radius_m + height_msl_m;
  const double up = height_msl_m - station_msl_m - 2 * to * std::pow(std::sin(angle / 2), 2);
  return radToDeg(std::atan2(up, to * std::sin(angle)));
}

double VerticalDiagram::groundRange_m(double slant_range_m, double height_msl_m) const {
  const double from = effective_earth_radius_m + station_msl_m, to = effective_earth_radius_m + height_msl_m;
  const double level2 = slant_range_m * slant_range_m - (to - from) * (to - from);
  const double sine = std::sqrt(std::max(level2, 0.0) / (from * to)) / 2;
  return level2 >= 0 && sine <= 1 ? 2 * effective_earth_radius_m * std::asin(sine) : NAN;
}

double VerticalDiagram::rayHeight_msl_m(double slant_range_m, double elevation_deg) const {
  const double from = effective_earth_radius_m + station_msl_m, angle = degToRad(elevation_deg);
  return std::hypot(slant_range_m * std::cos(angle), from + slant_range_m * std::sin(angle)) -
         effective_earth_radius_m;
}

}  // namespace emscape::study
