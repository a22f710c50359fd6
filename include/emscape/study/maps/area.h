/// Area of a map and its terrain.
#pragma once

#include <optional>
#include <string>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::study {

/// Area of a map: a box, or a circle in it; pixels outside the circle are left out. A box that contains a
/// pole has all longitudes.
struct MapArea {
  struct Circle {
    double latitude_deg = 0, longitude_deg = 0, radius_m = 0;
  };
  scenario::GeoBox box;
  std::optional<Circle> circle;
};

/// Area of a scenario's region; if it contains a pole, the circle around the region.
MapArea areaOf(const scenario::Region& region);
/// @throws Error (usage) for an invalid position or a radius outside 10 m..2000 km
MapArea circularArea(const MapArea::Circle& circle);
/// Parses "LATITUDE,LONGITUDE,RADIUS_M" or "bbox:WEST,SOUTH,EAST,NORTH" (degrees; a box across the
/// antimeridian has west > east).
/// @throws Error (usage) that names the text
MapArea parseArea(const std::string& text);
/// The mistake in the coordinates of an area that is nowhere near the region, and near it without the
/// mistake; empty: there is none.
std::string mistakenAreaText(const MapArea& area, const scenario::Region& region);

/// Box of terrain needed by maps of an area: the area, all platforms and a margin.
scenario::GeoBox terrainBoxOf(const scenario::Scenario& scenario, const MapArea& area);
/// Loads the scenario's terrain over an area and all platforms; null if the scenario names none.
/// @throws Error (bad_input) naming the file
scenario::TerrainPtr loadTerrain(const scenario::Scenario& scenario, const MapArea& area);

}  // namespace emscape::study
