/// One elevation file, as GDAL reads it, in the terms of terrain: posts, metres, voids.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/scenario/terrain.h"
#include "scenario/terrain/posts.h"

namespace emscape::scenario {

/// Posts at the centres of the raster's pixels: what GDAL calls a pixel's centre is where the height was
/// taken, for pixel-is-area as for pixel-is-point (GDAL moves the latter's corners by half a pixel when it
/// opens them). Not safe to share between threads.
class TerrainFile {
 public:
  /// Opens the file; reads no heights.
  /// @param place  where the scenario names it; may be empty
  /// @throws Error (bad_input): no such file, not a raster, no georeference, heights of an unknown unit
  TerrainFile(const std::string& file, const SourceLocation& place);
  ~TerrainFile();

  const std::string& name() const;
  const std::string& format() const;
  std::string crs() const;
  /// What a user should know: bands left out, unit converted, positions brought to WGS84.
  const std::vector<std::string>& notes() const;

  const PostLattice& lattice() const;
  int columns() const;
  int rows() const;
  /// The heights stand for areas (the file reaches half a post beyond its posts), not for points.
  bool isArea() const;

  /// Takes a row of heights (m above the file's datum; NaN where void), counted from the window's southern
  /// one.
  using RowSink = std::function<void(long long row, const float* heights_m)>;
  /// Reads a window of the file, a strip of rows at a time; hands over each row once.
  /// @throws Error (bad_input) if reading fails
  void read(const PostWindow& window, const RowSink& take) const;

  /// True: the lattice is of longitudes and latitudes of WGS84 (deg). False: of a plane of its own.
  bool isGeographic() const;
  /// The same text for files whose lattices lie in the same plane.
  const std::string& planeName() const;
  /// Brings points of the plane to longitude and latitude (deg) in place; NaN where there are none.
  void toGeographic(std::vector<double>& x, std::vector<double>& y) const;
  /// Brings longitudes and latitudes (deg) to the plane in place; NaN where it has no such point.
  void toPlane(std::vector<double>& x, std::vector<double>& y) const;
  /// The same for points in line, a hundredth of a post wrong at most and much faster.
  void lineToPlane(std::vector<double>& x, std::vector<double>& y) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::scenario
