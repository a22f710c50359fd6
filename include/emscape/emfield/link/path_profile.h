/// The terrain under one path, the ray above it, and the obstacles.
#pragma once

#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::emfield {

/// One end of a path.
struct PathEnd {
  GeodeticPosition position;
  double height_msl_m = 0;
};

/// Terrain profile of a path in the vertical plane through both ends, on the effective earth, on which the
/// ray is straight. Arrays run from the station (range 0) to the point below the far end.
struct PathProfile {
  double k_factor = 0;                  ///< effective earth radius over earth radius
  double effective_earth_radius_m = 0;  ///< at the station
  PathEnd begin, end;
  double azimuth_rad = 0;  ///< at the station, clockwise from north
  double range_m = 0;      ///< along the ground, > 0
  std::vector<double> ranges_m;
  std::vector<float> ground_msl_m;
  std::vector<double> ray_msl_m;  ///< height of the ray between the ends
  bool at_crossings = false;      ///< see readPathProfile()
  bool has_terrain = false;       ///< false: a smooth earth at mean sea level

  int count() const { return static_cast<int>(ranges_m.size()); }
  /// Clearance (m) of the ray above the ground; negative where the ground is above it.
  double clearance_m(int i) const { return ray_msl_m[i] - static_cast<double>(ground_msl_m[i]); }
  /// Height (m) of the effective earth's bulge above the chord between the ends.
  double bulge_m(int i) const {
    return ranges_m[i] * (range_m - ranges_m[i]) / (2 * effective_earth_radius_m);
  }
  /// Radius of the first Fresnel zone.
  double fresnelRadius_m(int i, double wavelength_m) const;
};

/// Reads the terrain along the path with the sampling of the field, and at the path's end.
/// @param terrain       null: a smooth earth at mean sea level
/// @param at_crossings  false: posts at half the spacing of the elevation model; true: where the path crosses
/// the lines between its posts, as the model diffraction reads them
/// @throws Error (bad_input) that names the first position without terrain, and for ends that are less than 1
/// m apart along the ground, or more than a quarter of the earth's circumference
PathProfile readPathProfile(const PathEnd& begin, const PathEnd& end,
                            const propagation::Atmosphere& atmosphere, const scenario::Terrain* terrain,
                            bool at_crossings);
/// The same in air whose refractivity is linear in height.
PathProfile readPathProfile(const PathEnd& begin, const PathEnd& end, double k_factor,
                            const scenario::Terrain* terrain, bool at_crossings);

/// A point where the ground enters the ray's first Fresnel zone, or is closest to it.
struct PathObstacle {
  int post = 0;  ///< of the profile
  double range_m = 0;
  double ground_msl_m = 0;
  double clearance_m = 0;  ///< negative: the ground is above the ray
  double fresnel_radius_m = 0;
  double nu = 0;                ///< P.526-15 eq. (26)
  double knife_edge_db = 0;     ///< J(nu): the loss of this obstacle alone, as a knife edge
  bool is_earth_bulge = false;  ///< above the ray only because of the earth's curvature
  bool decides = false;         ///< the largest nu of all

  double clearanceInFresnelRadii() const { return clearance_m / fresnel_radius_m; }
};

/// The obstacles with a clearance below 0.6 Fresnel radii, at most the eight largest, in order from the
/// station. If there is none, the point with the smallest clearance. Two crests are separate obstacles if the
/// ground between them is lower by half a Fresnel radius, or by a third of the smaller crest's obstruction.
/// Empty if the profile has no sample between the ends.
std::vector<PathObstacle> pathObstacles(const PathProfile& profile, double wavelength_m);

}  // namespace emscape::emfield
