/// The ground: elevation models as one mosaic.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/geo_frame.h"
#include "scenario/terrain_view.h"

namespace emscape::scenario {

/// Datum of the heights in the elevation files.
enum class VerticalDatum { egm96, ellipsoid };

/// A box of latitude and longitude (deg). east may exceed 180 where the box crosses the antimeridian; west is in -180..180.
struct GeoBox {
  double south_deg = 0, north_deg = 0, west_deg = 0, east_deg = 0;
};

struct TerrainSpec {
  std::vector<std::string> files;   ///< as resolved: absolute or relative to the working folder
  std::vector<FilePlace> places;    ///< where the scenario names each file
  VerticalDatum vertical_datum = VerticalDatum::egm96;
};

/// What `emscape info` says of one elevation file.
struct TerrainFileInfo {
  std::string file, format, crs;
  GeoBox box;
  int columns = 0, rows = 0;
  double post_spacing_lat_deg = 0, post_spacing_lon_deg = 0;
  double lowest_m = 0, highest_m = 0;
  long long void_posts = 0;
};

/// Heights above mean sea level, bilinear between posts. Immutable; safe to share between threads.
class Terrain {
 public:
  /// Reads what the files hold within the box (HGT, DTED, GeoTIFF in any CRS, VRT: whatever GDAL reads), tiles as one mosaic.
  /// @throws Error (bad_input) naming the file; a file that does not meet the box is no error
  static std::shared_ptr<const Terrain> load(const TerrainSpec& spec, const GeoBox& box);
  static TerrainFileInfo describe(const std::string& file);

  virtual ~Terrain() = default;
  /// Height (m, EGM96 mean sea level); NaN over a void or outside the files: missing terrain never looks like sea level.
  /// @param latitude_deg -90..90, longitude_deg any (wrapped)
  virtual double heightMsl_m(double latitude_deg, double longitude_deg) const = 0;
  /// The same heights for loops, without a virtual call; valid while the terrain lives.
  virtual TerrainView view() const = 0;
  /// Finest distance between posts (m).
  virtual double postSpacing_m() const = 0;
  /// Posts of the box that are void, and the part of the box (0..1) that no file covers.
  virtual long long voidPosts() const = 0;
  virtual double uncoveredFraction() const = 0;
  /// What the box of load() was, and the box that the files cover.
  virtual GeoBox box() const = 0;
  virtual GeoBox coverage() const = 0;
  virtual double lowest_m() const = 0;
  virtual double highest_m() const = 0;
};

using TerrainPtr = std::shared_ptr<const Terrain>;

}  // namespace emscape::scenario
