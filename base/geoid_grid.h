/// Undulations of a geoid in a global grid of posts, read from a file.
#pragma once

#include <string>
#include <vector>

namespace emscape {

/// Part of the globe for which a grid's posts are read.
struct GeoidArea {
  double south_deg = -90, north_deg = 90;
  double west_deg = -180, east_deg = 180;  ///< east - west: 0..360; 360 or more: the whole circle
};

/// Geoid undulations, bicubic between posts that are evenly spaced in latitude and longitude. Immutable; safe
/// to share between threads.
class GeoidGrid {
 public:
  /// Reads the posts around an area from a global grid of 360 n x (180 n + 1) posts: PROJ's GTX and GeoTIFF
  /// files, GeographicLib's PGM files, and other georeferenced files that GDAL reads.
  /// @throws Error (bad_input) naming the file: not readable, or not such a grid
  explicit GeoidGrid(const std::string& file, const GeoidArea& area = {});

  /// Undulation (m) at a point of the area; NaN outside it.
  /// @param latitude_deg   clamped to -90..90
  /// @param longitude_deg  any; wrapped
  double undulation_m(double latitude_deg, double longitude_deg) const;

 private:
  void read(const std::string& file, const GeoidArea& area);

  int posts_per_degree_ = 0;
  int first_row_ = 0, first_column_ = 0;  ///< of posts_, counted from the south pole and 180 degrees west
  int row_count_ = 0, column_count_ = 0;  ///< of posts_
  std::vector<float> posts_;              ///< m; the southern row first
};

/// Finds the file of a geoid grid in the folders of PROJ and GeographicLib.
/// @param names     file names, the preferred first
/// @param searched  receives the folders, separated by commas
/// @return empty if there is none
std::string findGeoidFile(const std::vector<std::string>& names, std::string& searched);

/// EGM2008 around an area, from the finest installed grid: us_nga_egm08_25.tif or egm08_25.gtx (PROJ, 2.5
/// minutes), egm2008-2_5.pgm, egm2008-5.pgm or egm2008-1.pgm (GeographicLib).
/// @throws Error (bad_input) that states what to install if there is none
GeoidGrid egm2008Grid(const GeoidArea& area);

}  // namespace emscape
