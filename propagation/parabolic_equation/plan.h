/// Plan of an emitter's marches of the parabolic equation: steps, domain, azimuths and cells, chosen from the
/// scenario and reported.
#pragma once

#include <vector>

#include "propagation/choice.h"
#include "propagation/inputs.h"
#include "propagation/parabolic_equation/march/march_azimuths.h"
#include "propagation/radial.h"

namespace emscape::propagation {

constexpr ModelLimit kPeTriedFrequency{"frequency",
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
                              -30,
                              30,
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

/// Requirements for the domain of a march. Heights are above the lowest ground.
struct DomainNeeds {
  double required_m = 0;  ///< the antenna and all ground are below it
  double wanted_m = 0;    ///< no field is read above it
  double post_spacing_m = 0;
  double farthest_m = 0;
  double spacing_m = 0;  ///< of the positions along the ground, resolved by the range steps; 0: one position
  bool is_single = false;  ///< one path: the domain contains wanted_m at any cost
  bool is_narrow = false;  ///< few azimuths: the angle is that of a single path
  double slope_rad = 0;    ///< slopes of the ground that the band should hold
  double ridge_rad = 0;    ///< largest angle at which the field passes a ridge
};

/// The needs of ground at even steps, for an automatic largest angle.
struct GroundNeeds {
  std::vector<float> slopes_rad;
  double ridge_rad = 0;

  /// Adds a path. Ridges are seen from a height at its begin, from PeSight::kNearGround_m on.
  void add(const float* ground_msl_m, int count, double step_m, double eye_msl_m, double curvature_per_m);
  /// Slope (rad) of a fraction of the steps, at most that of kPeSlope.
  double slope_rad(double fraction);
};

/// Grid from the emitter's settings; missing settings are chosen.
/// @param max_angle_rad  receives the largest angle
/// @throws Error (bad_input) outside the limits
AutomaticGrid planGrid(const EmitterInputs& emitter, const RefractivityAlongPath& air,
                       const DomainNeeds& needs, double& max_angle_rad);

/// The surfaces of a march, one per polarisation: two for those that are half horizontal, half vertical.
std::vector<PeSurface> planSurfaces(const EmitterInputs& emitter, const RefractivityAlongPath& air);

/// Top (m above mean sea level) of the highest trapping layer; 0: none.
double trappingTop_m(const RefractivityAlongPath& air);

/// The member's air whose trapping layer has the highest top.
RefractivityAlongPath highestDuct(const std::vector<RefractivityAlongPath>& airs);

struct PePlan {
  MarchGrid grid;
  RadialCells cells;
  std::vector<PeSurface> surfaces;
  /// For each member of the air's ensemble (one without an ensemble): one for all azimuths, or one per
  /// azimuth.
  std::vector<std::vector<RefractivityAlongPath>> air;
  int azimuths = 0;
  std::vector<int> ranges;  ///< AzimuthMarch::ranges
  bool is_around = false;   ///< the last azimuth's neighbour is the first
  double first_azimuth_rad = 0, azimuth_step_rad = 0;
  double max_angle_rad = 0;
  double min_range_m = 0;  ///< at shorter ranges other models are used
  double top_msl_m = 0;    ///< above it: extended along the ray
  std::vector<ModelChoice> choices;

  double azimuth_rad(int i) const { return first_azimuth_rad + i * azimuth_step_rad; }
};

/// The domain's needs along the azimuths, for any settings of the model.
DomainNeeds domainNeeds(const PathInputs& inputs, const RadialInputs& radials);
/// @param needs  domainNeeds()
/// @throws Error (bad_input) outside the limits, with the value and the allowed range
PePlan planMarch(const PathInputs& inputs, const RadialInputs& radials, const DomainNeeds& needs);
/// The same without the air along the azimuths and what depends on it: over terrain, for trials.
/// @param members  of the air's ensemble
PePlan planWithoutAir(const PathInputs& inputs, const RadialInputs& radials, const DomainNeeds& needs,
                      int members);

}  // namespace emscape::propagation
