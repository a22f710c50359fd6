/// Ground that the marches of `parabolic_equation` do not hold, and the largest angle that would.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace emscape::propagation {

/// Lengths (m) of the march along one azimuth.
struct SteepAzimuth {
  double azimuth_rad = 0;
  double whole_m = 0;       ///< to the farthest position
  double staircases_m = 0;  ///< over ground that the band of the equation does not hold
  double behind_m = 0;      ///< beyond ground that the antenna sees above the largest angle
};

/// The marches of one plan; up to 64 azimuths stand for all.
struct SteepGround {
  double max_angle_deg = 0;  ///< of the plan
  bool is_automatic = true;  ///< false: the angle is set
  std::vector<SteepAzimuth> azimuths;
  /// The same azimuths, planned with another setting of `max_angle_deg` (0: automatic); empty: such a plan is
  /// refused. Reads the terrain of the plan, which must still exist. Thread-safe.
  std::function<std::vector<SteepAzimuth>(double max_angle_deg)> with;

  /// Part of the length, 0..1, over staircases or beyond steep ground.
  double lostPart() const;
};

/// One sentence for all marches of an emitter: the part of their length that is lost, the azimuths at which,
/// and the least `max_angle_deg` whose plans lose at most half of it over all of them, or that none does. It
/// makes up to 15 plans of each march.
/// @return empty: too little is lost
std::string steepGroundWarning(const std::vector<SteepGround>& marches);

}  // namespace emscape::propagation
