/// The air along one azimuth of an emitter's paths.
#pragma once

#include <cstddef>
#include <vector>

#include "propagation/inputs.h"
#include "propagation/parabolic_equation/refractivity.h"

namespace emscape::propagation {

/// M along an azimuth: the atmosphere's refractivity, of an ensemble that of the mean values; without it, the
/// gradient with which a ray has the curvature of 1 - 1/k of the earth's, for the atmosphere's k_factor.
///
/// Profiles by range count from the site. Of profiles by place, each point of the path has the mean, weighted
/// by the inverse square of the distances to the places (those below 100 m as 100 m), level by level where
/// all profiles have as many levels, else height by height. The mean is taken at 129 points up to 1.25 times
/// the distance of the farthest place; behind them the last holds.
RefractivityAlongPath pathAir(const Atmosphere& atmosphere, const Site& site, double azimuth_rad);
/// The same for each member of the atmosphere's ensemble; without one, pathAir() alone.
std::vector<RefractivityAlongPath> pathAirs(const Atmosphere& atmosphere, const Site& site,
                                            double azimuth_rad);

/// The air over ground that is land in places: there it has no evaporation duct (withoutEvaporationDuct()). A
/// shore lies between two posts. Land above the duct's top is left as it is: no field there is in the duct.
/// @param ground_msl_m  at 0, 1, 2, ... steps; land: above 0
RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air, const float* ground_msl_m,
                                          std::size_t count, double step_m);
/// The same over a smooth earth that is land throughout.
RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air);

}  // namespace emscape::propagation
