/// The area of a map, and the terrain over it.
#pragma once

#include <optional>
#include <string>

#include "emscape/scenario/scenario.h"
#include "emscape/scenario/terrain.h"

namespace emscape::study {

/// Area of a map: a box, or a circle in it, beyond which pixels are left out. With a pole in it the box has
/// all longitudes.
struct MapArea {
  struct Circle {
    double latitude_deg = 0, longitude_deg = 0, radius_m = 0;
  };
  scenario::GeoBox box;
  std::optional<Circle> circle;
};

/// The area of a scenario's region; with a pole in it, the circle around it.
MapArea areaOf(const scenario::Region& region);
/// @throws Error (usage) for a position that is none or a radius outside 10 m..2000 km
MapArea circularArea(const MapArea::Circle& circle);
/// Parses "LATITUDE,LONGITUDE,RADIUS_M" or "bbox:WEST,SOUTH,EAST,NORTH" (degrees; a box across the
/// antimeridian has west > east).
/// @throws Error (usage) that names the text
MapArea parseArea(const std::string& text);

/// The box of terrain that maps of an area need: with all platforms, and a margin.
scenario::GeoBox terrainBoxOf(const scenario::Scenario& scenario, const MapArea& area);
/// The terrain that a scenario names, over an area and all platforms; null if it names none.
/// @throws Error (bad_input) naming the file
scenario::TerrainPtr loadTerrain(const scenario::Scenario& scenario, const MapArea& area);

}  // namespace emscape::study
