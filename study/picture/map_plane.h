/// The plane of a map's projection: positions, the area's outline, the graticule.
#pragma once

#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/study/maps/map_grid.h"

namespace emscape::study {

using GeoPoint = emfield::Surface::Position;

/// Metres of the projection; NaN without an image.
struct PlanePoint {
  double east_m = 0, north_m = 0;
};

/// A meridian or a parallel in the frame of a map and around it.
struct GraticuleLine {
  bool is_meridian = false;
  std::string text;  ///< "84.3°W"
  std::vector<PlanePoint> points;
};

class MapPlane {
 public:
  /// @param grid  must outlive the plane; without a projection (wkt) nothing has an image
  explicit MapPlane(const MapGrid& grid);

  std::vector<PlanePoint> pointsAt(const std::vector<GeoPoint>& positions) const;
  /// Latitude NaN without an image.
  std::vector<GeoPoint> positionsAt(const std::vector<PlanePoint>& points) const;

  /// The border of the grid's area, closed; empty: unknown, or with a pole.
  std::vector<PlanePoint> outline() const;
  /// Meridians and parallels at round degrees. @param count  approximate number of each
  std::vector<GraticuleLine> graticule(int count) const;

  /// In the middle of the frame.
  struct Scale {
    double metres_per_metre = 1;  ///< on the ground, of a metre of the plane to the east
    double north_rad = 0;         ///< direction of true north, clockwise from the plane's
  };
  Scale scale() const;

  /// "EPSG:32616 (WGS 84 / UTM zone 16N)".
  std::string name() const;

 private:
  PlanePoint at(double column, double row) const {
    return {grid_.left_m + column * grid_.cell_m, grid_.top_m - row * grid_.cell_m};
  }
  PlanePoint middle() const { return at(grid_.width / 2.0, grid_.height / 2.0); }
  bool isInFrame(const PlanePoint& point) const;

  const MapGrid& grid_;
  gdal::Transformation to_plane_;  ///< null without a projection
};

/// Round steps of degrees in [lowest, highest], about `count` of them, with texts: "84.3°W".
/// @param is_meridian  of longitudes, which may exceed 180
struct DegreeTick {
  double degrees = 0;
  std::string text;
};
std::vector<DegreeTick> degreeTicks(double lowest_deg, double highest_deg, int count, bool is_meridian);

}  // namespace emscape::study
