#include "emscape/study/maps/area.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/study/maps/map_grid.h"
#include "scenario/file/far_outside.h"

namespace emscape::study {

namespace {

/// Distance to the nearer pole (m).
double poleDistance_m(double latitude_deg) {
  return geodesicInverse(latitude_deg, 0, latitude_deg < 0 ? -90 : 90, 0).distance_m;
}

}  // namespace

MapArea areaOf(const scenario::Region& region) {
  const GeoFrame frame(region.origin);
  if (poleDistance_m(region.origin.latitude_deg) <= 0.5 * region.size_m.y) {
    return circularArea({region.origin.latitude_deg, region.origin.longitude_deg,
                         0.5 * std::hypot(region.size_m.x, region.size_m.y)});
  }
  MapArea area;
  area.box = {90, -90, 1e9, -1e9};
  const double middle_deg = region.origin.longitude_deg;
  for (const double x : {-0.5, 0.0, 0.5}) {
    for (const double y : {-0.5, 0.0, 0.5}) {
      const GeodeticPosition at = frame.toGeodetic({x * region.size_m.x, y * region.size_m.y, 0});
      const double longitude_deg = middle_deg + std::remainder(at.longitude_deg - middle_deg, 360.0);
      area.box.south_deg = std::min(area.box.south_deg, at.latitude_deg);
      area.box.north_deg = std::max(area.box.north_deg, at.latitude_deg);
      area.box.west_deg = std::min(area.box.west_deg, longitude_deg);
      area.box.east_deg = std::max(area.box.east_deg, longitude_deg);
    }
  }
  return area;
}

MapArea circularArea(const MapArea::Circle& circle) {
  if (!(circle.latitude_deg >= -90 && circle.latitude_deg <= 90 && circle.longitude_deg >= -180 &&
        circle.longitude_deg <= 180)) {
    throw Error(ErrorCode::usage,
                fmt::format("area: latitude {}, longitude {} is not a position (-90..90, -180..180 deg)",
                            circle.latitude_deg, circle.longitude_deg));
  }
  if (!(circle.radius_m >= 10 && circle.radius_m <= 2e6)) {
    throw Error(ErrorCode::usage, fmt::format("area: radius {} m; 10 to 2000000 m", circle.radius_m));
  }
  MapArea area;
  area.circle = circle;
  const auto towards = [&](double azimuth_deg) {
    return geodesicDirect(circle.latitude_deg, circle.longitude_deg, degToRad(azimuth_deg), circle.radius_m);
  };
  area.box.north_deg = towards(0.0).latitude_deg;
  area.box.south_deg = towards(180.0).latitude_deg;
  const bool is_north = circle.latitude_deg >= 0;
  if (poleDistance_m(circle.latitude_deg) <= circle.radius_m) {
    (is_north ? area.box.north_deg : area.box.south_deg) = is_north ? 90 : -90;
    area.box.west_deg = circle.longitude_deg - 180;
    area.box.east_deg = circle.longitude_deg + 180;
    return area;
  }
  // The easternmost point of a circle is beyond its azimuth of 90 degrees, toward the nearer pole.
  double half_width_deg = 0;
  for (double azimuth_deg = is_north ? 0 : 45; azimuth_deg <= (is_north ? 135 : 180); azimuth_deg += 0.5) {
    half_width_deg = std::max(
        half_width_deg, std::remainder(towards(azimuth_deg).longitude_deg - circle.longitude_deg, 360.0));
  }
  area.box.west_deg = circle.longitude_deg - half_width_deg;
  area.box.east_deg = circle.longitude_deg + half_width_deg;
  return area;
}

scenario::GeoBox terrainBoxOf(const scenario::Scenario& scenario, const MapArea& area) {
  constexpr double kMargin_deg = 0.02;
  scenario::GeoBox box = scenario::terrainBox(scenario);
  const double turn_deg = 360 * std::round((box.west_deg - area.box.west_deg) / 360);
  box.south_deg = std::max(std::min(box.south_deg, area.box.south_deg - kMargin_deg), -90.0);
  box.north_deg = std::min(std::max(box.north_deg, area.box.north_deg + kMargin_deg), 90.0);
  const double west_deg = std::min(box.west_deg, area.box.west_deg + turn_deg - kMargin_deg);
  const double east_deg = std::max(box.east_deg, area.box.east_deg + turn_deg + kMargin_deg);
  box.west_deg = wrapLongitude_deg(west_deg);
  box.east_deg = std::min(box.west_deg + east_deg - west_deg, box.west_deg + 360);
  return box;
}

scenario::TerrainPtr loadTerrain(const scenario::Scenario& scenario, const MapArea& area) {
  if (!scenario.terrain) return nullptr;
  return scenario::Terrain::load(*scenario.terrain, terrainBoxOf(scenario, area),
                                 scenario::neededPlaces(scenario));
}

void requireGround(const scenario::Scenario& scenario, const scenario::Terrain& terrain,
                   const MapGrid& grid) {
  std::size_t missing = 0, pixels = 0;
  emfield::Surface::Position first{};
  for (const emfield::Surface::Position& at : grid.positions) {
    if (std::isnan(at.latitude_deg)) continue;
    ++pixels;
    if (!std::isnan(terrain.heightMsl_m(at.latitude_deg, at.longitude_deg))) continue;
    if (missing++ == 0) first = at;
  }
  if (missing == 0 || (missing < pixels && scenario::mayLackTerrain(scenario, true))) return;
  const bool is_all = missing == pixels;
  const SourceLocation location = scenario.terrain->locations.empty() ? SourceLocation{scenario.file, 0, 0}
                                                                      : scenario.terrain->locations.front();
  throw Error(
      ErrorCode::bad_input, location,
      fmt::format(
          "terrain is missing below {} of the map's {} pixels, first at latitude {:.5f}, longitude {:.5f} "
          "deg; {}",
          missing, pixels, first.latitude_deg, first.longitude_deg,
          is_all ? terrain.placeText() : scenario::kMissingTerrainRemedy));
}

std::string mistakenAreaText(const MapArea& area, const scenario::Region& region) {
  const double latitude_deg = 0.5 * (area.box.south_deg + area.box.north_deg);
  const double longitude_deg = wrapLongitude_deg(0.5 * (area.box.west_deg + area.box.east_deg));
  const std::string text = scenario::mistakenPlaceText(region, latitude_deg, longitude_deg);
  return text.empty() ? "" : "of its middle, " + text;
}

MapArea parseArea(const std::string& text) {
  const bool is_box = text.rfind("bbox:", 0) == 0;
  std::vector<double> numbers;
  std::string rest = is_box ? text.substr(5) : text;
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::usage, fmt::format("area '{}': {}; LATITUDE,LONGITUDE,RADIUS_M or "
                                              "bbox:WEST,SOUTH,EAST,NORTH (degrees)",
                                              text, why));
  };
  for (std::size_t begin = 0; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find(',', begin), rest.size());
    const std::string word = rest.substr(begin, end - begin);
    char* stop = nullptr;
    const double number = std::strtod(word.c_str(), &stop);
    if (word.empty() || *stop != '\0' || !std::isfinite(number)) refuse("'" + word + "' is not a number");
    numbers.push_back(number);
    begin = end + 1;
  }
  if (numbers.size() != (is_box ? 4u : 3u)) refuse(fmt::format("{} numbers", numbers.size()));
  if (!is_box) return circularArea({numbers[0], numbers[1], numbers[2]});
  MapArea area;
  area.box = {numbers[1], numbers[3], numbers[0], numbers[2]};
  if (area.box.east_deg < area.box.west_deg) area.box.east_deg += 360;  // across the antimeridian
  const bool is_on_earth = area.box.south_deg >= -90 && area.box.north_deg <= 90 &&
                           area.box.west_deg >= -180 && area.box.west_deg <= 180 &&
                           area.box.east_deg <= area.box.west_deg + 360;
  if (!is_on_earth || !(area.box.south_deg < area.box.north_deg && area.box.west_deg < area.box.east_deg)) {
    refuse("that is no box on the earth");
  }
  return area;
}

}  // namespace emscape::study
