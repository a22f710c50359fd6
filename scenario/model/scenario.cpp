#include "emscape/scenario/model/scenario.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"

namespace emscape::scenario {

namespace {

constexpr double kMargin_deg = 0.018;  // 2 km of latitude

/// A bounding box of points, with longitudes relative to a reference so that it may cross the antimeridian.
class BoxBuilder {
 public:
  explicit BoxBuilder(double reference_longitude_deg) : reference_deg_(reference_longitude_deg) {}

  void add(double latitude_deg, double longitude_deg) {
    const double offset_deg = wrapLongitude_deg(longitude_deg - reference_deg_);
    south_deg_ = std::min(south_deg_, latitude_deg);
    north_deg_ = std::max(north_deg_, latitude_deg);
    west_offset_deg_ = std::min(west_offset_deg_, offset_deg);
    east_offset_deg_ = std::max(east_offset_deg_, offset_deg);
  }

  /// Around a pole: all longitudes.
  void addPole(double latitude_deg) {
    add(latitude_deg, reference_deg_);
    west_offset_deg_ = -180;
    east_offset_deg_ = 180;
  }

  GeoBox box() const {
    // The shortest way between two points of one latitude bulges towards the pole: tan(peak) = tan(latitude)
    // / cos(half the span).
    const double half_span_deg = std::min((east_offset_deg_ - west_offset_deg_) / 2, 89.0);
    const auto bulged = [&](double latitude_deg) {
      if (std::abs(latitude_deg) >= 90) return latitude_deg;
      return radToDeg(std::atan(std::tan(degToRad(latitude_deg)) / std::cos(degToRad(half_span_deg))));
    };
    GeoBox box;
    box.south_deg = std::max((south_deg_ < 0 ? bulged(south_deg_) : south_deg_) - kMargin_deg, -90.0);
    box.north_deg = std::min((north_deg_ > 0 ? bulged(north_deg_) : north_deg_) + kMargin_deg, 90.0);
    const double furthest_deg = std::max(std::abs(box.south_deg), std::abs(box.north_deg));
    const double margin_deg = kMargin_deg / std::max(std::cos(degToRad(furthest_deg)), 1e-6);
    const double span_deg = east_offset_deg_ - west_offset_deg_ + 2 * margin_deg;
    if (span_deg >= 360) {
      box.west_deg = -180;
      box.east_deg = 180;
    } else {
      box.west_deg = wrapLongitude_deg(reference_deg_ + west_offset_deg_ - margin_deg);
      box.east_deg = box.west_deg + span_deg;
    }
    return box;
  }

 private:
  double reference_deg_;
  double south_deg_ = 90, north_deg_ = -90, west_offset_deg_ = 0, east_offset_deg_ = 0;
};

void addRegion(BoxBuilder& builder, const Region& region) {
  // Points of the edge are so dense that everything between them is within the margin for any region within a
  // hemisphere.
  constexpr int kPointsPerEdge = 33;
  const GeoFrame frame(region.origin);
  const double half_x_m = region.size_m.x / 2, half_y_m = region.size_m.y / 2;
  for (int i = 0; i < kPointsPerEdge; ++i) {
    const double part = 2.0 * i / (kPointsPerEdge - 1) - 1;
    for (const Vec3d& point : {Vec3d{part * half_x_m, -half_y_m, 0}, Vec3d{part * half_x_m, half_y_m, 0},
                               Vec3d{-half_x_m, part * half_y_m, 0}, Vec3d{half_x_m, part * half_y_m, 0}}) {
      const GeodeticPosition position = frame.toGeodetic(point);
      builder.add(position.latitude_deg, position.longitude_deg);
    }
  }
  for (const double pole_deg : {-90.0, 90.0}) {
    const double latitude_deg = region.origin.latitude_deg;
    if (geodesicInverse(latitude_deg, 0, pole_deg, 0).distance_m <= std::hypot(half_x_m, half_y_m)) {
      builder.addPole(pole_deg);
    }
  }
}

void addTrack(BoxBuilder& builder, const std::vector<TrackPoint>& track) {
  // Legs are geodesics; a leg that spans many degrees of longitude is sampled more densely.
  constexpr double kStep_deg = 1;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const SitePosition& a = track[i].position;
    builder.add(a.latitude_deg, a.longitude_deg);
    if (i + 1 == track.size()) break;
    const SitePosition& b = track[i + 1].position;
    const double turn_deg = std::abs(wrapLongitude_deg(b.longitude_deg - a.longitude_deg));
    if (turn_deg <= kStep_deg) continue;
    const GeodesicInverse leg =
        geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg);
    for (double part = kStep_deg / turn_deg; part < 1; part += kStep_deg / turn_deg) {
      const GeodeticPosition between =
          geodesicDirect(a.latitude_deg, a.longitude_deg, leg.azimuth_rad, leg.distance_m * part);
      builder.add(between.latitude_deg, between.longitude_deg);
    }
  }
}

}  // namespace

GeoBox terrainBox(const Scenario& scenario) {
  BoxBuilder builder(scenario.region.origin.longitude_deg);
  addRegion(builder, scenario.region);
  for (const Platform& platform : scenario.platforms) addTrack(builder, platform.track);
  return builder.box();
}

std::vector<NeededPlace> neededPlaces(const Scenario& scenario) {
  std::vector<NeededPlace> places;
  const FrameOrigin& origin = scenario.region.origin;
  places.push_back({"the region", origin.latitude_deg, origin.longitude_deg});
  for (const Platform& platform : scenario.platforms) {
    if (platform.track.empty()) continue;
    const SitePosition& first = platform.track.front().position;
    places.push_back({"platform '" + platform.name + "'", first.latitude_deg, first.longitude_deg});
  }
  return places;
}

TerrainPtr loadTerrain(const Scenario& scenario) {
  return scenario.terrain ? Terrain::load(*scenario.terrain, terrainBox(scenario), neededPlaces(scenario))
                          : nullptr;
}

bool hasClutterMap(const Scenario& scenario) {
  return scenario.terrain &&
         (scenario.terrain->land_cover.isGiven() || !scenario.terrain->surface_files.empty());
}

bool mayLackTerrain(const Scenario& scenario, bool otherwise) {
  if (!scenario.terrain || !scenario.terrain->missing) return otherwise;
  return *scenario.terrain->missing != MissingTerrain::error;
}

}  // namespace emscape::scenario
