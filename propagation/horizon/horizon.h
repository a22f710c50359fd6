/// Model `horizon`: terrain and earth masking along straight rays over an earth of effective radius k a.
///
/// A point is in sight if no terrain between it and the emitter is above the ray between them. Behind terrain
/// there is no field (no diffraction: an upper bound of shadow). Refractivity is assumed to be linear in
/// height, so that rays are straight over the effective earth (ITU-R P.834; k from the gradient of P.453, 4/3
/// by default).
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"

namespace emscape::propagation {

/// Above this height (m) the linear refractivity profile no longer holds.
constexpr double kLinearRefractivityHeight_m = 10000;

/// Terms of a ground range: sine and 1 - cosine of the angle that it subtends at the earth's centre.
template <class Real>
struct RangeTerms {
  Real sine = 0;
  Real versine = 0;
};

/// Rays from one station over an earth of effective radius, in the vertical plane of one azimuth.
template <class Real>
struct HorizonGeometry {
  Real station_height_msl_m;
  Real effective_earth_radius_m;

  /// @param range_m  ground range (m), 0 up to a quarter of the earth's circumference
  EMSCAPE_HD RangeTerms<Real> termsAt(double range_m) const {
    const double angle = range_m / double(effective_earth_radius_m);
    const double half_sine = std::sin(angle / 2);
    return {Real(std::sin(angle)), Real(2 * half_sine * half_sine)};
  }

  /// Tangent of the elevation, at the station, of the ray to a point at a height (m) and a ground range > 0.
  EMSCAPE_HD Real slopeTo(Real height_msl_m, const RangeTerms<Real>& range) const {
    return (height_msl_m - station_height_msl_m - range.versine * (effective_earth_radius_m + height_msl_m)) /
           (range.sine * (effective_earth_radius_m + height_msl_m));
  }

  /// Height (m) at which the ray of a slope passes over a ground range: the inverse of slopeTo.
  EMSCAPE_HD Real heightOn(Real slope, const RangeTerms<Real>& range) const {
    const Real rise = range.versine + slope * range.sine;
    return (station_height_msl_m + effective_earth_radius_m * rise) / (1 - rise);
  }
};

/// Slope of the ray that grazes the terrain along one azimuth: the largest slope to its samples. A point
/// beyond them is in sight if the slope to it is at least this.
template <class Real>
struct GrazingSlope {
  Real highest = -Real(HUGE_VAL), unknown = 0;

  /// @param slope  slopeTo() a sample of that height
  EMSCAPE_HD void add(Real height_msl_m, Real slope) {
    highest = slope > highest ? slope : highest;
    unknown += height_msl_m - height_msl_m;
  }
  /// -infinity without a sample; NaN if the height of one is.
  EMSCAPE_HD Real value() const { return highest + unknown; }
};

/// Slope of that ray over a smooth earth at mean sea level, in closed form. Nearer than the horizon it is the
/// slope to a centimetre below the surface, so that rounding does not put points on the surface in shadow.
/// @param range_m  of the point
template <class Real>
EMSCAPE_HD Real smoothGrazingSlope(const HorizonGeometry<Real>& geometry, double range_m) {
  const double radius_m = double(geometry.effective_earth_radius_m);
  const double height_m = double(geometry.station_height_msl_m);
  if (height_m < 0) return Real(HUGE_VAL);
  const double tangent = std::sqrt(height_m * (2 * radius_m + height_m)) / radius_m;  // of the dip
  constexpr double kBelow_m = 0.01;
  if (range_m < radius_m * std::atan(tangent))
    return geometry.slopeTo(Real(-kBelow_m), geometry.termsAt(range_m));
  return Real(-tangent);
}

}  // namespace emscape::propagation
