/// The pixels of a map: squares of a projection, and their positions on the earth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/base/unset_vector.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/study/maps/area.h"

namespace emscape::study {

/// Rows run from north to south, pixels in them from west to east.
struct MapGrid {
  int width = 0, height = 0;
  double cell_m = 0;                                  ///< side of a pixel in the projection
  double left_m = 0, top_m = 0;                       ///< outer corner of the first pixel
  std::string crs;                                    ///< "EPSG:32616", or "local"
  std::string wkt;                                    ///< WKT2
  std::optional<MapArea> area;                        ///< that the pixels cover; none: unknown
  UnsetVector<emfield::Surface::Position> positions;  ///< the pixels' centres; latitude NaN: left out
  std::vector<float> areas_m2;                        ///< of the pixels, on the ellipsoid

  std::size_t pixels() const { return positions.size(); }
  /// The pixel that contains a position; -1: none.
  long long pixelAt(double latitude_deg, double longitude_deg) const;
};

/// The pixels that cover an area. Their corners are at whole multiples of cell_m, so that maps of one
/// projection and cell fit each other.
/// @param crs  "utm" (the zone of the area's middle, with the exceptions of Norway and Svalbard), "local"
/// (azimuthal equidistant about it), or "EPSG:N", a projection in metres
/// @throws Error (usage) for an unknown or unsuitable crs, a cell size that is not positive, or more than
/// 2^26 pixels
/// @accuracy positions within 1 mm of the exact projection
MapGrid makeMapGrid(const MapArea& area, double cell_m, const std::string& crs);

/// @throws Error (bad_input) if terrain is missing below all pixels, or below some although the scenario says
/// that this is an error
void requireGround(const scenario::Scenario& scenario, const scenario::Terrain& terrain, const MapGrid& grid);

/// The pixels of an existing map, none left out.
/// @param wkt  of its projection, in metres  @param crs  its name
/// @throws Error (bad_input) if the projection cannot be used
MapGrid mapGridAt(const std::string& wkt, const std::string& crs, double cell_m, double left_m, double top_m,
                  int width, int height);

}  // namespace emscape::study
