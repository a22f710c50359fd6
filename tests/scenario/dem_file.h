/// Elevation files for tests, written by GDAL.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace emscape::test {

/// A GeoTIFF of 32-bit floats to be written. Values are of pixels: column from the west, row from the north
/// (unless the transform says otherwise).
struct DemFile {
  int columns = 0, rows = 0;
  std::array<double, 6> transform{};  ///< GDAL's: corners of pixels to the CRS
  std::function<double(int column, int row)> value;
  std::string crs = "EPSG:4326";  ///< empty: none
  bool is_point = false;
  std::optional<double> nodata;
  std::string unit;
  double scale = 1, offset = 0;
  bool is_geotiff_1_0 = false;
  int bands = 1;  ///< all but the first hold 2345

  void write(const std::filesystem::path& path) const;
};

/// A pixel-is-area file of longitudes and latitudes: `height(latitude_deg, longitude_deg)` at the pixels'
/// centres.
DemFile geographicDem(double west_deg, double north_deg, double step_deg, int columns, int rows,
                      const std::function<double(double latitude_deg, double longitude_deg)>& height);
/// The same as pixel-is-point: the outer posts are at the given corner.
DemFile geographicPointDem(double west_deg, double north_deg, double step_deg, int columns, int rows,
                           const std::function<double(double latitude_deg, double longitude_deg)>& height);

/// A CRS's coordinates (east, north) of a point of WGS84.
std::array<double, 2> projected(const std::string& crs, double latitude_deg, double longitude_deg);

/// Writes files into a ZIP archive, and one file as .gz. @param members  names in the archive and files
void writeZip(const std::string& archive, const std::vector<std::pair<std::string, std::string>>& members);
void writeGzip(const std::string& from, const std::string& to);
/// An HGT tile: big-endian posts, `height(column, row)` from the north-western corner.
void writeHgt(const std::string& file, int posts, const std::function<int(int column, int row)>& height);

/// A GeoTIFF of bytes in red, green and blue, 10 x 10 pixels of 0.1 degrees from 10 E, 50 N. @param value  24
/// bits
void writeColours(const std::string& file, const std::function<long(int column, int row)>& value);

/// Writes a copy of a GeoTIFF with whole numbers of 16 bits and colours, as rasters of classes have. @return
/// `to`
std::string wholeNumbers(const std::string& from, const std::string& to);

/// Writes a raster in another format. @param driver  GDAL's name of the format
void convertDem(const std::string& from, const std::string& driver, const std::string& to);

}  // namespace emscape::test
