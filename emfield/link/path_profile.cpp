#include "emscape/emfield/link/path_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/columns/station.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/diffraction/knife_edge.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {
namespace {

void checkTerrain(const PathProfile& profile, const scenario::Terrain& terrain) {
  const auto hole = std::find_if(profile.ground_msl_m.begin(), profile.ground_msl_m.end(),
                                 [](float height_m) { return std::isnan(height_m); });
  if (hole == profile.ground_msl_m.end()) return;
  const double range_m = profile.ranges_m[static_cast<std::size_t>(hole - profile.ground_msl_m.begin())];
  const GeodeticPosition position =
      geodesicDirect(profile.begin.position.latitude_deg, profile.begin.position.longitude_deg,
                     profile.azimuth_rad, range_m);
  const scenario::GeoBox box = terrain.coverage();
  throw Error(
      ErrorCode::bad_input, {},
      fmt::format("terrain is missing on the path, {:.2f} km from the emitter at latitude {:.5f}, longitude "
                  "{:.5f} deg; the elevation data that is loaded covers latitude {:.5f}..{:.5f}, longitude "
                  "{:.5f}..{:.5f} deg; {}",
                  range_m / 1000, position.latitude_deg, position.longitude_deg, box.south_deg, box.north_deg,
                  box.west_deg, box.east_deg, scenario::kMissingTerrainRemedy),
      Hint::allow_missing_terrain);
}

PathObstacle obstacleAt(const PathProfile& profile, int post, double wavelength_m) {
  PathObstacle obstacle;
  obstacle.post = post;
  obstacle.range_m = profile.ranges_m[post];
  obstacle.ground_msl_m = static_cast<double>(profile.ground_msl_m[post]);
  obstacle.cover_m = profile.coverAt_m(post);
  obstacle.clearance_m = profile.clearance_m(post);
  obstacle.fresnel_radius_m = profile.fresnelRadius_m(post, wavelength_m);
  obstacle.nu = -std::sqrt(2.0) * obstacle.clearanceInFresnelRadii();
  obstacle.knife_edge_db = propagation::knifeEdgeDb(obstacle.nu);
  obstacle.is_cover = obstacle.cover_m > 0 && obstacle.clearance_m + obstacle.cover_m >= 0;
  return obstacle;
}

/// Marks the obstacles that are there by the earth's curvature, from the loss of the path by delta-Bullington
/// and that of the smooth earth below it.
void markEarth(const PathProfile& profile, double wavelength_m, std::vector<PathObstacle>& obstacles) {
  constexpr double kLittle = 0.25;  // of the loss
  const bool is_in_sight = std::none_of(obstacles.begin(), obstacles.end(), [](const PathObstacle& obstacle) {
    return obstacle.clearance_m < 0;
  });
  if (is_in_sight) return;
  propagation::DiffractionParameters parameters;
  parameters.frequency_hz = kSpeedOfLight / wavelength_m;
  parameters.effective_earth_radius_m = profile.effective_earth_radius_m;
  using Model = propagation::DiffractionModel<double>;
  const double begin_m = profile.ray_msl_m.front(), end_m = profile.ray_msl_m.back();
  const propagation::DeltaBullington<double> loss = propagation::deltaBullington(
      propagation::diffractionModel<double>(parameters),
      propagation::TerrainProfile{profile.ranges_m.data(), profile.ground_msl_m.data(), profile.count()},
      begin_m, end_m);
  // Of the antennas above the smooth earth, without what the model raises low ones by.
  const auto horizonOf_m = [&](double effective_m, double antenna_m, float ground_m) {
    const double lift_m = Model::raised_m(antenna_m, static_cast<double>(ground_m)) - antenna_m;
    return std::sqrt(2 * profile.effective_earth_radius_m * std::max(effective_m - lift_m, 0.0));
  };
  if (profile.range_m <= horizonOf_m(loss.effective.tx_m, begin_m, profile.ground_msl_m.front()) +
                             horizonOf_m(loss.effective.rx_m, end_m, profile.ground_msl_m.back()))
    return;
  const bool costs_little = loss.loss_db - loss.spherical_db < kLittle * loss.loss_db;
  for (PathObstacle& obstacle : obstacles) {
    const bool is_above = obstacle.clearance_m < 0 && !obstacle.is_cover;
    obstacle.is_earth_bulge =
        is_above && (costs_little || obstacle.clearance_m + profile.bulge_m(obstacle.post) >= 0);
  }
}

void setRay(PathProfile& profile, const Station& station) {
  const Refraction& refraction = station.refraction;
  const propagation::HorizonGeometry<double> geometry{station.effective_height_msl_m,
                                                      station.effective_earth_radius_m};
  const double end_msl_m =
      refraction.effectiveHeight_m(profile.end.height_msl_m, profile.begin.height_msl_m, profile.range_m);
  const double slope = geometry.slopeTo(end_msl_m, geometry.termsAt(profile.range_m));
  profile.ray_msl_m.clear();
  for (const double range_m : profile.ranges_m) {
    profile.ray_msl_m.push_back(refraction.heightOfImage_m(
        geometry.heightOn(slope, geometry.termsAt(range_m)), profile.begin.height_msl_m, range_m));
  }
}

}  // namespace

double PathProfile::fresnelRadius_m(int i, double wavelength_m) const {
  const double d1 = ranges_m[i], d2 = range_m - d1;
  return std::sqrt(wavelength_m * d1 * d2 / range_m);
}

PathProfile readPathProfile(const PathEnd& begin, const PathEnd& end, double k_factor,
                            const scenario::Terrain* terrain, bool at_crossings) {
  propagation::Atmosphere atmosphere;
  atmosphere.k_factor = k_factor;
  return readPathProfile(begin, end, atmosphere, terrain, at_crossings);
}

PathProfile readPathProfile(const PathEnd& begin, const PathEnd& end,
                            const propagation::Atmosphere& atmosphere, const scenario::Terrain* terrain,
                            bool at_crossings) {
  PathProfile profile;
  const Station station = makeStation(begin.position, begin.height_msl_m, atmosphere);
  profile.k_factor = atmosphere.k_factor;
  profile.effective_earth_radius_m = station.effective_earth_radius_m;
  profile.begin = begin;
  profile.end = end;
  profile.at_crossings = at_crossings;
  profile.has_terrain = terrain != nullptr;
  const FastInverse inverse = fastInverse(
      station.geodesy, surfacePoint(end.position.latitude_deg, end.position.longitude_deg).ecef_m);
  profile.azimuth_rad = std::atan2(inverse.sin_azimuth, inverse.cos_azimuth);
  if (profile.azimuth_rad < 0) profile.azimuth_rad += 2 * kPi;
  profile.range_m = inverse.distance_m;
  const double longest_m = 0.5 * kPi * station.earth_radius_m;
  if (!(profile.range_m >= kMinPath_m && profile.range_m <= longest_m)) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("the path is {:.6g} km long over the ground; profiles are drawn from {:g} to {:.0f} km",
                    profile.range_m / 1000, kMinPath_m / 1000, longest_m / 1000));
  }
  const std::vector<double> regular_m = postRanges(profile.range_m, postSpacing_m(terrain));
  const GroundPosts ground = groundPosts(terrain, regular_m);
  const auto most = static_cast<std::size_t>(maxPosts(station, ground, at_crossings));
  profile.ranges_m.resize(most);
  profile.ground_msl_m.resize(most);
  const auto nearer = static_cast<std::size_t>(readProfileCpu(
      station, ground, inverse, at_crossings, profile.ranges_m.data(), profile.ground_msl_m.data()));
  profile.ranges_m.resize(nearer);
  profile.ranges_m.push_back(profile.range_m);
  profile.ground_msl_m.resize(nearer + 1, 0.0f);
  if (terrain != nullptr) {
    profile.ground_msl_m.back() =
        static_cast<float>(terrain->heightMsl_m(end.position.latitude_deg, end.position.longitude_deg));
  }
  if (terrain != nullptr) checkTerrain(profile, *terrain);

  setRay(profile, station);
  return profile;
}

PathProfile withEvenPosts(PathProfile profile, const propagation::Atmosphere& atmosphere,
                          const scenario::Terrain& terrain) {
  constexpr double kRounding = 1e-9;
  const Station station = makeStation(profile.begin.position, profile.begin.height_msl_m, atmosphere);
  const double spacings = profile.range_m / (postSpacing_m(&terrain) / 2);
  const int steps = std::max(1, static_cast<int>(std::ceil(spacings - kRounding)));
  std::vector<double> ranges_m;
  for (int i = 0; i < steps; ++i) ranges_m.push_back(profile.range_m * i / steps);
  std::vector<float> ground_msl_m(ranges_m.size());
  readPostsCpu(station, groundPosts(&terrain, ranges_m),
               {profile.range_m, std::sin(profile.azimuth_rad), std::cos(profile.azimuth_rad)}, 0, steps,
               ground_msl_m.data());
  ranges_m.push_back(profile.range_m);
  ground_msl_m.push_back(profile.ground_msl_m.back());
  profile.ranges_m = std::move(ranges_m);
  profile.ground_msl_m = std::move(ground_msl_m);
  profile.cover_m.clear();
  checkTerrain(profile, terrain);
  setRay(profile, station);
  return profile;
}

PathProfile withCover(PathProfile profile, const PathCover& cover,
                      const propagation::Atmosphere& atmosphere) {
  profile.ranges_m = cover.ranges_m;
  profile.ground_msl_m = cover.ground_msl_m;
  profile.cover_m = cover.height_m;
  setRay(profile, makeStation(profile.begin.position, profile.begin.height_msl_m, atmosphere));
  return profile;
}

std::vector<PathObstacle> pathObstacles(const PathProfile& profile, double wavelength_m) {
  constexpr double kFreeZone = 0.6;  // Fresnel radii
  constexpr std::size_t kMaxCrests = 8;
  const auto obstruction = [&](int i) {  // Fresnel radii
    return -profile.clearance_m(i) / profile.fresnelRadius_m(i, wavelength_m);
  };
  const auto isSeparatedBy = [](double crest, double valley) {
    return crest - valley > std::max(0.5, crest / 3);
  };
  std::vector<PathObstacle> crests;
  int crest = -1;             // highest post since the last valley
  double valley = -HUGE_VAL;  // lowest value since the last accepted crest
  bool rising = true;
  for (int i = 1; i < profile.count() - 1; ++i) {
    const double here = obstruction(i);
    if (rising) {
      if (crest < 0 || here > obstruction(crest)) crest = i;
      if (isSeparatedBy(obstruction(crest), here)) {
        crests.push_back(obstacleAt(profile, crest, wavelength_m));
        rising = false;
        valley = here;
      }
    } else {
      valley = std::min(valley, here);
      if (isSeparatedBy(here, valley)) {
        rising = true;
        crest = i;
      }
    }
  }
  if (rising && crest >= 0) crests.push_back(obstacleAt(profile, crest, wavelength_m));
  if (crests.empty()) return crests;

  std::sort(crests.begin(), crests.end(),
            [](const PathObstacle& a, const PathObstacle& b) { return a.nu > b.nu; });
  crests.front().decides = true;
  const auto first_free = std::find_if(crests.begin() + 1, crests.end(), [&](const PathObstacle& obstacle) {
    return obstacle.clearanceInFresnelRadii() >= kFreeZone;
  });
  crests.erase(first_free, crests.end());
  crests.resize(std::min(crests.size(), kMaxCrests));
  std::sort(crests.begin(), crests.end(),
            [](const PathObstacle& a, const PathObstacle& b) { return a.range_m < b.range_m; });
  markEarth(profile, wavelength_m, crests);
  return crests;
}

}  // namespace emscape::emfield
