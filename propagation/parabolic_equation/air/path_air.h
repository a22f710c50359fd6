/// Refractivity along one azimuth of an emitter's paths.
#pragma once

#include <cstddef>
#include <vector>

#include "propagation/inputs.h"
#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {

/// M along an azimuth: the atmosphere's refractivity (of an ensemble, that of the mean values). Without it,
/// the gradient at which a ray's curvature is 1 - 1/k of the earth's, for the atmosphere's k_factor.
///
/// Profiles by range refer to the range from the site. With profiles by position, each point of the path has
/// their mean, weighted by the inverse square of the distances (at least 100 m). It is taken level by level
/// if all profiles have the same number of levels, else height by height, at 129 points up to 1.25 times the
/// distance of the farthest position; the last one holds beyond.
RefractivityAlongPath pathAir(const Atmosphere& atmosphere, const Site& site, double azimuth_rad);
/// pathAir() for each member of the atmosphere's ensemble; without an ensemble one element, pathAir().
std::vector<RefractivityAlongPath> pathAirs(const Atmosphere& atmosphere, const Site& site,
                                            double azimuth_rad);

/// The air without evaporation duct over land (withoutEvaporationDuct()). A shore is between two posts. Land
/// above the duct's top does not change the air: no field there is in the duct.
/// @param ground_msl_m  at 0, 1, 2, ... steps; land: above 0
RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air, const float* ground_msl_m,
                                          std::size_t count, double step_m);
/// The same for a smooth earth without sea.
RefractivityAlongPath withoutDuctOverLand(const RefractivityAlongPath& air);

}  // namespace emscape::propagation
