/// The air along one azimuth of an emitter's paths.
#pragma once

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

}  // namespace emscape::propagation
