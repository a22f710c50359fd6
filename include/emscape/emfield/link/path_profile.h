/// The terrain under one path, what stands on it, the ray above it, and the obstacles.
#pragma once

#include <string>
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
  /// Height above the ground of the trees and buildings that the model reads; empty: none. See withCover().
  std::vector<float> cover_m;
  std::vector<double> ray_msl_m;  ///< height of the ray between the ends
  bool at_crossings = false;      ///< see readPathProfile()
  bool has_terrain = false;       ///< false: a smooth earth at mean sea level

  int count() const { return static_cast<int>(ranges_m.size()); }
  double coverAt_m(int i) const { return cover_m.empty() ? 0 : static_cast<double>(cover_m[i]); }
  /// Height of the ground, or of the trees and buildings on it.
  double topMsl_m(int i) const { return static_cast<double>(ground_msl_m[i]) + coverAt_m(i); }
  /// Clearance (m) of the ray above that; negative where the ray is lower.
  double clearance_m(int i) const { return ray_msl_m[i] - topMsl_m(i); }
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

/// The profile with posts that are equally far apart, at most half the spacing of the elevation model: they
/// are at the same places with the ends exchanged, as a march needs them. Without cover.
/// @throws Error (bad_input) that names the first position without terrain
PathProfile withEvenPosts(PathProfile profile, const propagation::Atmosphere& atmosphere,
                          const scenario::Terrain& terrain);

/// Trees and buildings along a path.
struct PathCover {
  std::vector<double> ranges_m;  ///< of the path's profile, and those where the cover begins
  std::vector<float> ground_msl_m;
  std::vector<float> height_m;  ///< above the ground; 0 where nothing stands
};

/// The profile with posts where trees and buildings begin, and with their heights.
PathProfile withCover(PathProfile profile, const PathCover& cover, const propagation::Atmosphere& atmosphere);

/// A point where the ground, or what stands on it, enters the ray's first Fresnel zone, or is closest to it.
struct PathObstacle {
  int post = 0;  ///< of the profile
  double range_m = 0;
  double ground_msl_m = 0;
  double cover_m = 0;      ///< height of the trees or buildings on the ground there; 0: none
  std::string cover_name;  ///< their class in the land cover; empty: not known
  double clearance_m = 0;  ///< of the ray above ground and cover; negative: they are above the ray
  double fresnel_radius_m = 0;
  double nu = 0;             ///< P.526-15 eq. (26)
  double knife_edge_db = 0;  ///< J(nu): the loss of this obstacle alone, as a knife edge
  /// Above the ray because of the earth's curvature: the smooth earth below the terrain hides the ends from
  /// each other, and the terrain alone is below the ray or adds less than a quarter of the loss.
  bool is_earth_bulge = false;
  bool is_cover = false;  ///< trees or buildings are nearest to the ray, and the ground is below it
  bool decides = false;   ///< the largest nu of all

  double clearanceInFresnelRadii() const { return clearance_m / fresnel_radius_m; }
};

/// The obstacles with a clearance below 0.6 Fresnel radii, at most the eight largest, in order from the
/// station. If there is none, the point with the smallest clearance. Two crests are separate obstacles if the
/// ground between them is lower by half a Fresnel radius, or by a third of the smaller crest's obstruction.
/// Empty if the profile has no sample between the ends.
std::vector<PathObstacle> pathObstacles(const PathProfile& profile, double wavelength_m);

}  // namespace emscape::emfield
