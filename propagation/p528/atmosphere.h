/// P.528: rays through the layered atmosphere: end point, length and absorption.
#pragma once

#include <vector>

namespace emscape::propagation {

/// Earth radius (km) of the recommendation.
constexpr double kP528EarthRadius_km = 6371;

/// A traced ray.
struct P528Ray {
  double length_km = 0;
  double absorption_db = 0;
  double bending_rad = 0;          ///< by refraction, downwards
  double upper_elevation_rad = 0;  ///< of the ray at its upper end
};

/// Rays of one frequency through the mean annual global reference atmosphere (P.835).
///
/// Layers and refraction after ITU-R P.676 Annex 1, section 2.2. As in the published figures of the
/// recommendation, the total pressure is used as that of dry air. Safe to share between threads.
class P528Atmosphere {
 public:
  /// @param frequency_hz  100 MHz to 30 GHz
  explicit P528Atmosphere(double frequency_hz);

  /// A ray from a height up to another.
  /// @param elevation_rad  at the lower end; below 0 the ray first descends to its grazing point. A ray that
  /// would meet the ground is replaced by one that grazes it.
  /// @pre 0 <= lower_km <= upper_km <= 20
  P528Ray trace(double lower_km, double upper_km, double elevation_rad) const;

 private:
  struct Air {
    double refractive_index;
    double absorption_db_km;
  };
  Air airAt(double height_km) const;
  P528Ray traceUp(double lower_km, double upper_km, double elevation_rad) const;
  double grazingHeight_km(double height_km, double elevation_rad) const;

  std::vector<double> log_refractivity_;  ///< of N-units, at every kSpacing_km of height
  std::vector<double> log_absorption_;    ///< of dB/km
};

}  // namespace emscape::propagation
