/// Coasts and lakes of GSHHG, the Global Self-consistent Hierarchical High-resolution Geography, where it is
/// installed (Debian: gmt-gshhg-low, -high, -full).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// A part of a shore; it ends at the edge of a bin of the file, or is closed.
struct CoastLine {
  int level = 1;  ///< 1 coast, 2 shore of a lake, 3 of an island in a lake, 4 of a pond on such an island
  std::vector<GeodeticPosition> points;  ///< at height 0, longitudes without a jump
};

/// The shores in a box, with a margin of up to the size of a bin. Immutable; safe to share between threads.
class Coast {
 public:
  /// The finest installed data (to about 100 m, 200 m, 1 km, 5 km or 25 km): that of the folder $DIR_GSHHG,
  /// as of GMT, or of the usual folders of packages. Null if there is none, if GDAL cannot read netCDF, or if
  /// the files are not as expected.
  static std::shared_ptr<const Coast> installed(const GeoBox& box);
  /// @param file  binned_GSHHS_RESOLUTION.nc. @throws Error (bad_input) naming the file
  static std::shared_ptr<const Coast> read(const std::string& file, const GeoBox& box);

  /// Longitudes are near those of the box.
  const std::vector<CoastLine>& lines() const { return lines_; }
  /// True for sea, lakes and ponds. A position outside of the box and its margin is land.
  bool isWater(double latitude_deg, double longitude_deg) const;

 private:
  /// A cell of the file's grid of latitude and longitude.
  struct Bin {
    double south_deg = 0, west_deg = 0;
    int corner_level = 0;            ///< of its south-western corner: 0 sea, 1 land, 2 lake, ...
    std::size_t first = 0, end = 0;  ///< of lines_
  };

  double bin_deg_ = 1;
  std::vector<Bin> bins_;
  std::vector<CoastLine> lines_;
};

/// A place between the points of a grid: 0 is the first column and the first row.
struct GridPlace {
  double column = 0, row = 0;  ///< NaN: no image
};

/// Water (1) and land (0) at the points of a grid, lakes too: along a row they change where it crosses a
/// shore. The time grows with the number of points of the grid and that of the shores.
/// @param onGrid      places of the points of a shore
/// @param positionAt  the position of a point, which is called for the first ones of each row; latitude NaN:
///                    it is left out, and is land
std::vector<std::uint8_t> waterOnGrid(
    const Coast& coast, int columns, int rows,
    const std::function<std::vector<GridPlace>(const std::vector<GeodeticPosition>&)>& onGrid,
    const std::function<GeodeticPosition(int column, int row)>& positionAt);

}  // namespace emscape::scenario
