/// Undulations of a geoid in a global grid of posts, read from a file.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "emscape/base/host_device.h"

namespace emscape {

/// The posts of a geoid grid as plain data, for host and device. For a device, copy the posts there.
struct GeoidView {
  const float* posts_m = nullptr;  ///< the southern row first
  int posts_per_degree = 0;
  int first_row = 0, first_column = 0;  ///< counted from the south pole and 180 degrees west
  int row_count = 0, column_count = 0;

  /// Bicubic between posts; NaN outside them.
  /// @param latitude_deg   clamped to -90..90
  /// @param longitude_deg  any; wrapped
  EMSCAPE_HD double undulation_m(double latitude_deg, double longitude_deg) const {
    const int columns = 360 * posts_per_degree, rows = 180 * posts_per_degree + 1;
    const double u =
        (longitude_deg - 360.0 * std::floor((longitude_deg + 180.0) / 360.0) + 180.0) * posts_per_degree;
    const double clamped_deg = latitude_deg < -90.0 ? -90.0 : latitude_deg > 90.0 ? 90.0 : latitude_deg;
    const double v = (clamped_deg + 90.0) * posts_per_degree;
    if (!(u >= 0.0 && u <= columns && v >= 0.0)) return NAN;
    const int column = static_cast<int>(u) < columns - 1 ? static_cast<int>(u) : columns - 1;
    const int row = static_cast<int>(v) < rows - 2 ? static_cast<int>(v) : rows - 2;
    const int i = ((column - 1 - first_column) % columns + columns) % columns, j = row - 1 - first_row;
    if (i + 4 > column_count || j < 0 || j + 4 > row_count) return NAN;
    double x[4], y[4];
    setCubicWeights(u - column, x);
    setCubicWeights(v - row, y);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      const float* p = posts_m + static_cast<long long>(j + k) * column_count + i;
      sum += y[k] * (x[0] * static_cast<double>(p[0]) + x[1] * static_cast<double>(p[1]) +
                     x[2] * static_cast<double>(p[2]) + x[3] * static_cast<double>(p[3]));
    }
    return sum;
  }

 private:
  /// Lagrange's weights of the posts at -1, 0, 1, 2 for a point at t in 0..1.
  EMSCAPE_HD static void setCubicWeights(double t, double weights[4]) {
    const double a = t + 1.0, b = t - 1.0, c = t - 2.0;
    weights[0] = -t * b * c / 6.0;
    weights[1] = a * b * c / 2.0;
    weights[2] = -a * t * c / 2.0;
    weights[3] = a * t * b / 6.0;
  }
};

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
  double undulation_m(double latitude_deg, double longitude_deg) const {
    return view().undulation_m(latitude_deg, longitude_deg);
  }
  /// Valid while the grid lives.
  GeoidView view() const {
    return {posts_.data(), posts_per_degree_, first_row_, first_column_, row_count_, column_count_};
  }

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

/// The grid of geoidUndulation_m(): EGM96, the whole globe. @throws as that
const GeoidGrid& egm96Grid();

/// EGM2008 around an area, from the finest installed grid: us_nga_egm08_25.tif or egm08_25.gtx (PROJ, 2.5
/// minutes), egm2008-2_5.pgm, egm2008-5.pgm or egm2008-1.pgm (GeographicLib).
/// @throws Error (bad_input) that states what to install if there is none
GeoidGrid egm2008Grid(const GeoidArea& area);

}  // namespace emscape
