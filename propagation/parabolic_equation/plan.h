/// How the parabolic equation is marched around an emitter: steps, domain, azimuths and cells, chosen
/// from the scenario and reported.
#pragma once

#include <vector>

#include "propagation/choice.h"
#include "propagation/inputs.h"
#include "propagation/parabolic_equation/march_azimuths.h"
#include "propagation/radial.h"

namespace emscape::propagation {

constexpr ModelLimit kPeTriedFrequency{"frequency, of measurements",
                                       "MHz",
                                       1e6,
                                       30,
                                       20000,
                                       Beyond::warned,
                                       "above, the equation was not compared with measurements"};
constexpr ModelLimit kPeDistance{"distance", "km", 1000, 0, 1000, Beyond::refused, ""};
constexpr ModelLimit kPeSteps{
    "range steps", "", 1, 1, 20000, Beyond::refused, "shorter paths, or longer steps"};
constexpr ModelLimit kPeWork{"azimuths x steps x heights",
                             "10^9",
                             1e9,
                             0,
                             1000,
                             Beyond::refused,
                             "hours: fewer azimuths, a smaller angle or a lower top"};
constexpr ModelLimit kPeCells{"cells that are kept", "10^6", 1e6, 0, 1000, Beyond::refused, "4 bytes each"};
constexpr ModelLimit kPeSlope{"slope of the ground",
                              "degrees",
                              kPi / 180,
                              -15,
                              15,
                              Beyond::warned,
                              "steeper pieces are taken as steps of a staircase, and counted"};
constexpr ModelLimit kPeRoughness{"roughness (rms)",
                                  "m",
                                  1,
                                  0,
                                  2,
                                  Beyond::warned,
                                  "a sea under more than 20 m/s of wind; no shadowing of waves"};
constexpr const ModelLimit* kPeLimits[] = {&kPeFrequency, &kPeTriedFrequency, &kPeAngle,
                                           &kPeDistance,  &kPeSteps,          &kPeSlope,
                                           &kPeRoughness, &kPeWork,           &kPeCells};

/// What is asked of the domain of a march. Heights are above the lowest ground.
struct DomainNeeds {
  double required_m = 0;  ///< the antenna and all ground lie below it
  double wanted_m = 0;    ///< no field is read above it
  double post_spacing_m = 0;
  double farthest_m = 0;
  double spacing_m = 0;    ///< of the places along the ground, which the range steps resolve; 0: one place
  bool is_single = false;  ///< one azimuth: everything wanted is in the domain, whatever it costs
};

/// The grid by the emitter's settings, what they leave open chosen.
/// @param max_angle_rad  receives the largest angle
/// @throws Error (bad_input) outside the limits
AutomaticGrid planGrid(const EmitterInputs& emitter, const RefractivityAlongPath& air,
                       const DomainNeeds& needs, double& max_angle_rad);

/// The surfaces of a march, one per polarisation: two for those that are half horizontal, half vertical.
std::vector<PeSurface> planSurfaces(const EmitterInputs& emitter, const RefractivityAlongPath& air);

/// Top (m above mean sea level) of the highest layer that traps; 0: there is none.
double trappingTop_m(const RefractivityAlongPath& air);

/// Of several members' air the one that traps to the greatest height.
RefractivityAlongPath highestDuct(const std::vector<RefractivityAlongPath>& airs);

struct PePlan {
  MarchGrid grid;
  RadialCells cells;
  std::vector<PeSurface> surfaces;
  /// Of each member of the air's ensemble, one member without one: one for all azimuths, or one each.
  std::vector<std::vector<RefractivityAlongPath>> air;
  int azimuths = 0;
  std::vector<int> ranges;  ///< AzimuthMarch::ranges
  bool is_around = false;   ///< the last azimuth's neighbour is the first
  double first_azimuth_rad = 0, azimuth_step_rad = 0;
  double max_angle_rad = 0;
  double min_range_m = 0;  ///< nearer, other models speak
  double top_m = 0;        ///< in the cells' heights; above: along the ray from that height
  std::vector<ModelChoice> choices;

  double azimuth_rad(int i) const { return first_azimuth_rad + i * azimuth_step_rad; }
};

/// @throws Error (bad_input) outside the limits, with the value and what is allowed
PePlan planMarch(const PathInputs& inputs, const RadialInputs& radials);

}  // namespace emscape::propagation
