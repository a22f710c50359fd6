/// Georeference of a raster: its posts in a plane, and that plane on WGS84.
#pragma once

#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "scenario/terrain/posts.h"

namespace emscape::scenario {

/// Posts of a raster, at the centres of its pixels. Not safe to share between threads.
class Georeference {
 public:
  /// @param transform  GDAL's: pixels to the coordinate system
  /// @param is_area    the values are of areas, not of points
  /// @throws Error (bad_input), without a location: no extent, not on the earth
  Georeference(const double (&transform)[6], int columns, int rows, bool is_area);

  /// @param system  of the posts, without heights  @param name  of the raster, unique
  /// @throws Error (bad_input), without a location: no way to latitude and longitude
  void placeOnEarth(gdal::SpatialReference system, const std::string& name);

  PostLattice lattice;
  bool north_first = true;  ///< order of the raster's rows
  bool is_area = true;      ///< the raster extends half a post beyond its posts
  /// Rows or columns are not parallel to the axes of the system: the plane is that of the pixels.
  bool turned = false;
  bool is_geographic = false;  ///< the plane is of WGS84 longitudes and latitudes (deg)
  std::string plane_name;      ///< equal for rasters whose lattices are in the same plane

  OGRSpatialReferenceH system() const { return system_.get(); }
  /// Transforms points of the plane to longitude and latitude (deg) in place; NaN where that fails.
  void toGeographic(std::vector<double>& x, std::vector<double>& y) const;
  /// Transforms longitudes and latitudes (deg) to the plane in place; NaN where that fails.
  void toPlane(std::vector<double>& x, std::vector<double>& y) const;
  /// The same for points on a line: much faster, error at most a hundredth of a post.
  void lineToPlane(std::vector<double>& x, std::vector<double>& y) const;

 private:
  bool liesOnWgs84() const;
  void systemOfPlane(std::vector<double>& x, std::vector<double>& y) const;
  void planeOfSystem(std::vector<double>& x, std::vector<double>& y) const;

  int columns_, rows_;
  double pixel_to_system_[6];
  gdal::SpatialReference system_;
  gdal::Transformation to_wgs84_, from_wgs84_;  ///< null: the system is WGS84
  gdal::Owned<GDALDestroyApproxTransformer> line_transformer_;
};

}  // namespace emscape::scenario
