/// The ground: elevation models as one mosaic.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/terrain/land_cover.h"

namespace emscape::scenario {

using emscape::toString;

struct TerrainView;  // scenario/terrain/view.h

/// Datum of the heights in the elevation files. EGM2008 needs its geoid grid on the machine
/// (base/geodesy/geoid_grid.h). NAVD88 is used as EGM96, with a warning.
enum class VerticalDatum { egm96, ellipsoid, egm2008, navd88 };
constexpr auto namesOf(VerticalDatum) {
  return std::array{"egm96", "ellipsoid", "egm2008", "navd88"};
}

/// Unit of the heights in an elevation file: metres, international feet, US survey feet, parts of a metre.
enum class HeightUnit { m, ft, us_ft, dm, cm };
constexpr auto namesOf(HeightUnit) {
  return std::array{"m", "ft", "us_ft", "dm", "cm"};
}

/// Treatment of an elevation file with more than a few heights that are not on earth.
enum class ImplausibleHeights { error, as_void };
constexpr auto namesOf(ImplausibleHeights) {
  return std::array{"error", "void"};
}

/// How heights are stored in the red, green and blue of a picture.
enum class HeightEncoding { terrain_rgb, terrarium };
constexpr auto namesOf(HeightEncoding) {
  return std::array{"terrain-rgb", "terrarium"};
}

/// Treatment of positions without a height: an error, sea (0 m above mean sea level), no value.
enum class MissingTerrain { error, sea, mask };
constexpr auto namesOf(MissingTerrain) {
  return std::array{"error", "sea", "mask"};
}

/// A box of latitude and longitude (deg). east may exceed 180 where the box crosses the antimeridian; west is
/// in -180..180.
struct GeoBox {
  double south_deg = 0, north_deg = 0, west_deg = 0, east_deg = 0;
};

inline bool operator==(const GeoBox& a, const GeoBox& b) {
  return a.south_deg == b.south_deg && a.north_deg == b.north_deg && a.west_deg == b.west_deg &&
         a.east_deg == b.east_deg;
}

/// A position whose ground is needed, for hints.
struct NeededPlace {
  std::string name;  ///< "the region", "platform 'ship'"
  double latitude_deg = 0, longitude_deg = 0;
};

/// What a scenario states of an elevation file.
struct TerrainFileKeys {
  std::optional<VerticalDatum> vertical_datum;
  std::optional<HeightUnit> height_unit;
  std::optional<HeightEncoding> encoding;
  bool has_classes = false;  ///< codes of land cover in place of heights
  int band = 0;              ///< that holds the heights, counted from 1; 0: the first
  std::string crs;           ///< of the posts, for files that state none, such as EPSG:32633
  bool swap_bytes = false;   ///< heights of 16 bits are in the other byte order
  ImplausibleHeights implausible = ImplausibleHeights::error;
};

inline bool operator==(const TerrainFileKeys& a, const TerrainFileKeys& b) {
  return a.vertical_datum == b.vertical_datum && a.height_unit == b.height_unit && a.encoding == b.encoding &&
         a.band == b.band && a.crs == b.crs && a.swap_bytes == b.swap_bytes && a.implausible == b.implausible;
}

struct TerrainSpec {
  /// As resolved: absolute or relative to the working folder. Also folders, patterns (*, ?), ZIP archives and
  /// .gz files of elevation files.
  std::vector<std::string> files;
  std::vector<SourceLocation> locations;  ///< of each file's name in the scenario
  /// Of the files without a key of their own; empty: as each file states, EGM96 if it states none.
  std::optional<VerticalDatum> vertical_datum;
  std::vector<TerrainFileKeys> keys = {};  ///< of each file; if shorter, the others have none
  /// Empty: an error for volumes and paths; maps have no value there.
  std::optional<MissingTerrain> missing = {};
  /// A surface model, as `files`; empty: none. Its height above the ground is that of the clutter.
  std::vector<std::string> surface_files = {};
  std::vector<SourceLocation> surface_locations = {};
  std::vector<TerrainFileKeys> surface_keys = {};
  LandCoverSpec land_cover = {};

  /// All files whose pixels a field depends on: of the ground, of its surface and of the land cover.
  std::vector<std::string> rasters() const;
};

/// Remedies for an error of missing terrain.
inline constexpr const char* kMissingTerrainRemedy =
    "'terrain: {missing: sea}' takes it as sea, 'missing: mask' leaves it without values";

/// True for the same files, keys and treatment; locations are not compared.
inline bool operator==(const TerrainSpec& a, const TerrainSpec& b) {
  return a.files == b.files && a.vertical_datum == b.vertical_datum && a.keys == b.keys &&
         a.missing == b.missing && a.surface_files == b.surface_files && a.surface_keys == b.surface_keys &&
         a.land_cover == b.land_cover;
}
inline bool operator!=(const TerrainSpec& a, const TerrainSpec& b) {
  return !(a == b);
}

/// Description of one elevation file, for `emscape info`.
struct TerrainFileInfo {
  std::string file, format, crs;
  GeoBox box;  ///< what the file covers: to its outer posts, or half a post further if pixel_is_area
  int columns = 0, rows = 0;
  bool pixel_is_area = false;
  double post_spacing_lat_deg = 0, post_spacing_lon_deg = 0;  ///< in the middle of the file
  /// In the file's vertical datum; NaN if no height was read. Of files with more than 2^28 posts a part of
  /// the rows is read, as a note says.
  double lowest_m = 0, highest_m = 0;
  long long void_posts = 0;
  std::string vertical_datum;  ///< and its origin: stated by the file, by its format, assumed, ...
  std::string height_unit;
  bool is_needed = true;              ///< reaches the needed box; the heights of others are not read
  std::vector<std::string> notes;     ///< conversions that were needed, such as of a unit
  std::vector<std::string> warnings;  ///< what was assumed, its effect, and how to state it
};

/// Heights above mean sea level, bilinear between posts. Immutable; safe to share between threads.
///
/// - Posts are at the centres of GDAL's pixels, whether these stand for points or areas.
/// - Files whose posts are on one lattice (to a hundredth of a post) and touch are one raster: heights go on
///   between them. Where two have the same post (tiles that share an edge) the file listed first takes
///   precedence, unless it is void there. A raster of areas reaches half a post beyond its outer posts, with
///   their heights.
/// - Where rasters overlap, the finest with a height is used; at its rim it is continued into its neighbours.
/// - Voids are the file's nodata value or mask, -32767 and -32768, NaN, heights outside the range found on
///   earth, and fill values that the file does not declare: heights below -500 m that are more than 500 m
///   below all other heights around. A point between posts is void if one of its four posts is void and has a
///   weight.
/// - With TerrainSpec::missing = sea, voids and positions outside the files are at 0 m.
/// - Files in a projection or on another datum are brought to longitudes and latitudes of WGS84 when they are
///   read, bilinear, on posts twice as close as their own: four times the memory, and ridges keep their
///   height.
class Terrain {
 public:
  /// Reads what the files hold within the box (GeoTIFF in any CRS, HGT, DTED, ASCII grid, USGS DEM, EHdr BIL,
  /// Erdas Imagine, netCDF, XYZ, gridded GeoPackage, VRT of files in its own folder), tiles as one mosaic.
  /// @throws Error (bad_input) naming the file; a file outside the box is not an error
  /// @param places  what the box is made of; see placeText()
  static std::shared_ptr<const Terrain> load(const TerrainSpec& spec, const GeoBox& box,
                                             const std::vector<NeededPlace>& places = {});
  /// @param read_heights  false: only the file's head is read
  /// @throws Error (bad_input) as load() would for this file
  static TerrainFileInfo describe(const std::string& file, bool read_heights = true,
                                  const TerrainFileKeys& keys = {});
  /// Describes all files of folders, patterns and archives.
  /// @param needed  the heights of files outside this box are not read; null: all are
  /// @throws Error (bad_input) as load() would
  static std::vector<TerrainFileInfo> describeAll(const TerrainSpec& spec, const GeoBox* needed);

  virtual ~Terrain() = default;
  /// Height (m, EGM96 mean sea level); NaN over a void or outside the files, except with missing = sea:
  /// missing terrain looks like sea level only where the scenario says so.
  /// @param latitude_deg  -90..90, longitude_deg any (wrapped)
  virtual double heightMsl_m(double latitude_deg, double longitude_deg) const = 0;
  /// The same heights for loops, without a virtual call; valid while the terrain lives.
  virtual TerrainView view() const = 0;
  /// Finest distance between the files' posts (m), the smaller of north-south and east-west, but at least
  /// half the larger (meridians converge near the poles); NaN without a file in the box.
  virtual double postSpacing_m() const = 0;
  /// Posts of the box that are void in every file, and the fraction of the box (0..1) that no file covers.
  virtual long long voidPosts() const = 0;
  virtual double uncoveredFraction() const = 0;
  /// The box of load(), and the part of it that the files cover, as a box.
  virtual GeoBox box() const = 0;
  virtual GeoBox coverage() const = 0;
  /// Heights of the posts in the box (m); NaN if none is known.
  virtual double lowest_m() const = 0;
  virtual double highest_m() const = 0;
  /// What was assumed of the files, its effect, and how to state it; each once for all files.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// For errors of missing terrain: where the files are, where ground is needed, and the mistake without
  /// which both would meet, in the middle of the box or in one of the needed places.
  virtual std::string placeText() const { return ""; }
  /// Classes of the ground; null: none.
  virtual const LandCover* landCover() const { return nullptr; }
};

using TerrainPtr = std::shared_ptr<const Terrain>;

}  // namespace emscape::scenario
