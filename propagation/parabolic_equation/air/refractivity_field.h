/// Refractivity of a scenario's air: profiles by position or range, and the members of an ensemble.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {

/// Profiles of the air around all emitters: a single one, or one per range from the emitter, or one per
/// position.
struct RefractivityField {
  struct Position {
    double latitude_deg = 0, longitude_deg = 0;
  };
  std::vector<RefractivityProfile> profiles{standardRefractivity()};  ///< 1 or more
  std::vector<double> ranges_m;     ///< of the profiles, ascending, from each emitter; empty: not by range
  std::vector<Position> positions;  ///< of the profiles, no two the same; empty: not by place
  /// Height of an evaporation duct that is added to all profiles; 0: none.
  double evaporation_duct_m = 0;
};

/// @see Atmosphere::refractivity
struct Refractivity {
  RefractivityField air;                   ///< of an ensemble: that of the mean values
  std::vector<RefractivityField> members;  ///< of an ensemble; empty: `air` alone
  /// Quantile of the members' powers (0..1); none: their mean.
  std::optional<double> quantile;
  std::string source;  ///< of measured profiles, for people: the file, station, time and distance; else empty
};

/// True if both have the same values, or both are null.
bool areSame(const std::shared_ptr<const Refractivity>& a, const std::shared_ptr<const Refractivity>& b);

}  // namespace emscape::propagation
