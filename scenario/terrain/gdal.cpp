
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "scenario/terrain/file.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/raster_access.h"
#include "scenario/terrain/transformation.h"
#include "scenario/terrain/vrt.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

/// Values that mean void in HGT and DTED whatever a file's header says.
constexpr float kVoidValues[] = {-32767.0f, -32768.0f};
/// Largest height or depth on earth (m), with a margin; values beyond are undeclared voids.
constexpr float kMaxHeightOnEarth_m = 20000.0f;
/// Positions of another datum count as WGS84 if they are closer than this (posts).
constexpr double kSameDatum_posts = 0.05;
/// Georeferences are rounded in files: a lattice this close (posts) to whole fractions of a degree is snapped
/// to them.
constexpr double kSnap_posts = 0.01;
/// Largest error of positions interpolated between transformed ones (posts).
constexpr double kLineTolerance_posts = 0.01;
constexpr long long kStripPosts = 1 << 21;
/// Limits of a plausible georeference. Coordinates: metres or feet of a projection; angles are much smaller.
constexpr double kMaxCrsCoordinate = 1e9;
constexpr double kMinCrsStep = 1e-9;
constexpr double kMaxLongitude_deg = 1080;
constexpr int kMaxPostsPerAxis = 1 << 22;  ///< the whole earth in a third of an arc second

/// Metres of a band's unit; 0 if it is unknown.
double metresOf(const std::string& unit) {
  struct Unit {
    const char* name;
    double metres;
  };
  static constexpr double kUsSurveyFoot_m = 1200.0 / 3937.0;
  static constexpr Unit kUnits[] = {{"", 1.0},
                                    {"m", 1.0},
                                    {"metre", 1.0},
                                    {"metres", 1.0},
                                    {"meter", 1.0},
                                    {"meters", 1.0},
                                    {"cm", 0.01},
                                    {"centimetre", 0.01},
                                    {"dm", 0.1},
                                    {"decimetre", 0.1},
                                    {"km", 1000.0},
                                    {"kilometre", 1000.0},
                                    {"ft", 0.3048},
                                    {"foot", 0.3048},
                                    {"feet", 0.3048},
                                    {"international foot", 0.3048},
                                    {"us-ft", kUsSurveyFoot_m},
                                    {"ft-us", kUsSurveyFoot_m},
                                    {"ftus", kUsSurveyFoot_m},
                                    {"us ft", kUsSurveyFoot_m},
                                    {"sft", kUsSurveyFoot_m},
                                    {"us survey foot", kUsSurveyFoot_m},
                                    {"us survey feet", kUsSurveyFoot_m},
                                    {"u.s. survey foot", kUsSurveyFoot_m},
                                    {"foot_us", kUsSurveyFoot_m}};
  for (const Unit& known : kUnits) {
    if (EQUAL(unit.c_str(), known.name)) return known.metres;
  }
  return 0.0;
}

/// Snaps an axis of posts to whole fractions of a degree if that moves none of them by more than kSnap_posts.
void snapToDegrees(double& first, double& step, int count) {
  const double per_degree = std::round(1.0 / step);
  if (per_degree < 1.0) return;
  // Pixel-is-area posts are at odd halves.
  const double halves = std::round(first * 2.0 * per_degree);
  const double last = first + (count - 1) * step;
  const double snapped_first = halves / (2.0 * per_degree);
  const double snapped_last = (halves + 2.0 * (count - 1)) / (2.0 * per_degree);
  if (std::abs(snapped_first - first) > kSnap_posts * step ||
      std::abs(snapped_last - last) > kSnap_posts * step) {
    return;
  }
  first = snapped_first;
  step = 1.0 / per_degree;
}

std::string shortText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Points that could not be transformed become NaN.
void transform(const gdal::Transformation& transformation, std::vector<double>& x, std::vector<double>& y) {
  const GdalMessages quiet;
  std::vector<int> done(x.size());
  OCTTransformEx(transformation.get(), static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!done[k] || !std::isfinite(x[k]) || !std::isfinite(y[k])) x[k] = y[k] = std::nan("");
  }
}

/// A GDALTransformerFunc. @param transformation  an OGRCoordinateTransformationH; only applied forwards
int transformPoints(void* transformation, int /*backwards*/, int count, double* x, double* y, double* /*z*/,
                    int* done) {
  OCTTransformEx(static_cast<OGRCoordinateTransformationH>(transformation), count, x, y, nullptr, done);
  return TRUE;
}

}  // namespace

struct TerrainFile::Impl {
  std::string name;
  SourceLocation location;
  std::vector<std::string> notes, warnings;
  std::string format;
  int columns = 0, rows = 0;
  double scale = 1.0, offset = 0.0, unit_m = 1.0;
  bool has_unit = false;  ///< the file states the unit of its heights

  double pixel_to_crs[6] = {0, 1, 0, 0, 0, 1};
  bool turned =
      false;  ///< rows or columns are not parallel to the axes of the CRS: the plane is that of the pixels
  bool north_first = true;  ///< order of the file's rows
  PostLattice lattice;
  bool is_area = true;
  gdal::SpatialReference crs;
  bool geographic = false;
  std::string plane_name;
  gdal::Transformation to_wgs84, from_wgs84;
  gdal::Owned<GDALDestroyApproxTransformer> line_transformer;

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::bad_input, location, "elevation file " + name + ": " + problem);
  }

  std::set<fs::path> checkedSources() const;  ///< none if the file is not a VRT
  gdal::Dataset open() const;                 ///< after checkedSources()
  void checkDatasets(GDALDatasetH dataset, const std::set<fs::path>& sources) const;
  void readHead();
  void readBand(GDALRasterBandH band);
  void placePosts(GDALDatasetH dataset);
  void placeOnEarth(OGRSpatialReferenceH given);
  bool liesOnWgs84() const;
  void crsOfPlane(std::vector<double>& x, std::vector<double>& y) const;
  void planeOfCrs(std::vector<double>& x, std::vector<double>& y) const;
};

std::set<fs::path> TerrainFile::Impl::checkedSources() const {
  try {
    return sourcesOfVrt(name);
  } catch (const Error& error) {
    fail(error.message());
  }
}

gdal::Dataset TerrainFile::Impl::open() const {
  if (const std::string fault = gdal::faultOfName(name); !fault.empty()) fail(fault);
  const GdalMessages messages;
  gdal::Dataset dataset = openElevation(name);
  if (!dataset) fail(messages.explain("not a raster that GDAL reads"));
  return dataset;
}

void TerrainFile::Impl::checkDatasets(GDALDatasetH dataset, const std::set<fs::path>& sources) const {
  const std::string fault = faultOfDataset(dataset);
  if (!fault.empty()) fail(fault);
  std::error_code ignored;
  for (const fs::path& source : sources) {
    if (!fs::exists(source, ignored)) continue;  // GDAL reports it if its heights are read
    const GdalMessages messages;
    const gdal::Dataset opened = openElevationSource(source);
    const std::string fault_of_source =
        opened ? faultOfDataset(opened.get()) : messages.explain("cannot be read as an elevation file");
    if (!fault_of_source.empty()) fail("source " + source.string() + ": " + fault_of_source);
  }
}

void TerrainFile::Impl::readHead() {
  const GdalMessages quiet;  // constructed before the dataset, whose destructor may report errors
  gdal::prepare();
  const std::set<fs::path> sources = checkedSources();
  const gdal::Dataset dataset = open();
  const int bands = GDALGetRasterCount(dataset.get());
  if (bands == 0) {
    fail("has no raster band itself; name one of the data sets in it, as gdalinfo lists them");
  }
  GDALDriverH driver = GDALGetDatasetDriver(dataset.get());
  const char* long_name = GDALGetMetadataItem(driver, GDAL_DMD_LONGNAME, nullptr);
  format = long_name ? long_name : GDALGetDriverShortName(driver);
  columns = GDALGetRasterXSize(dataset.get());
  rows = GDALGetRasterYSize(dataset.get());
  if (columns > kMaxPostsPerAxis || rows > kMaxPostsPerAxis) {
    fail("has " + std::to_string(columns) + " x " + std::to_string(rows) + " posts, more than the allowed " +
         std::to_string(kMaxPostsPerAxis) + " in a row or column");
  }
  if (bands > 1) {
    notes.push_back("has " + std::to_string(bands) + " bands: heights are taken from the first");
  }
  checkDatasets(dataset.get(), sources);
  readBand(GDALGetRasterBand(dataset.get(), 1));
  placePosts(dataset.get());
  placeOnEarth(GDALGetSpatialRef(dataset.get()));
}

void TerrainFile::Impl::readBand(GDALRasterBandH band) {
  if (GDALDataTypeIsComplex(GDALGetRasterDataType(band))) fail("holds complex numbers, not heights");
  const GDALColorInterp meaning = GDALGetRasterColorInterpretation(band);
  if (meaning != GCI_Undefined && meaning != GCI_GrayIndex) {
    fail(std::string("is a picture, not heights: its first band is '") +
         GDALGetColorInterpretationName(meaning) +
         "'. Tiles that encode heights in colours become heights by gdal_calc.py -R FILE --R_band=1 -G FILE "
         "--G_band=2 -B FILE --B_band=3 --type=Float32 --outfile=HEIGHTS.tif --calc=, for Terrain-RGB "
         "'-10000+(R*65536.0+G*256.0+B)*0.1', for Terrarium 'R*256.0+G+B/256.0-32768'");
  }
  scale = GDALGetRasterScale(band, nullptr);
  offset = GDALGetRasterOffset(band, nullptr);
  const std::string unit = GDALGetRasterUnitType(band);
  unit_m = metresOf(unit);
  if (unit_m == 0.0) {
    fail("heights are in '" + unit + "', a unit that is not known; known are m, ft and US survey ft");
  }
  has_unit = !unit.empty();
  if (unit_m != 1.0) notes.push_back("heights in '" + unit + "' are converted to metres");
  if (scale != 1.0 || offset != 0.0) {
    notes.push_back("heights are stored with scale " + std::to_string(scale) + " and offset " +
                    std::to_string(offset));
  }
}

void TerrainFile::Impl::placePosts(GDALDatasetH dataset) {
  double* g = pixel_to_crs;
  if (GDALGetGeoTransform(dataset, g) != CE_None) fail("has no georeference");
  const double area = g[1] * g[5] - g[2] * g[4];
  double reach = 0;  // of the raster's corners from the CRS's origin
  for (const double column : {0.0, double(columns)}) {
    for (const double row : {0.0, double(rows)}) {
      reach = std::max(
          {reach, std::abs(g[0] + column * g[1] + row * g[2]), std::abs(g[3] + column * g[4] + row * g[5])});
      if (std::isnan(g[0] + column * g[1] + row * g[2] + g[3] + column * g[4] + row * g[5])) reach = HUGE_VAL;
    }
  }
  if (!std::isfinite(reach) || !std::isfinite(area) || area == 0.0) {
    fail("has a georeference of no extent");
  }
  if (reach > kMaxCrsCoordinate) {
    fail("its posts are not on the earth: a coordinate is " + shortText(reach) + ", more than the allowed " +
         shortText(kMaxCrsCoordinate));
  }
  const double step = std::min(std::hypot(g[1], g[4]), std::hypot(g[2], g[5]));
  if (step < kMinCrsStep) {
    fail("its posts are " + shortText(step) + " apart, less than the allowed " + shortText(kMinCrsStep) +
         " of the coordinates' unit");
  }
  const char* meaning = GDALGetMetadataItem(dataset, GDALMD_AREA_OR_POINT, nullptr);
  is_area = meaning == nullptr || !EQUAL(meaning, GDALMD_AOP_POINT);
  turned = g[2] != 0.0 || g[4] != 0.0 || g[1] < 0.0;
  if (turned) {
    north_first = false;
  } else {
    north_first = g[5] < 0.0;
    lattice.step_x = g[1];
    lattice.step_y = std::abs(g[5]);
    lattice.x0 = g[0] + 0.5 * g[1];
    lattice.y0 = g[3] + (north_first ? rows - 0.5 : 0.5) * g[5];
  }
}

void TerrainFile::Impl::placeOnEarth(OGRSpatialReferenceH given) {
  GdalMessages messages;
  if (given == nullptr || OSRGetName(given) == nullptr) {
    // Only formats with a place for it can be edited; for the others GDAL reads a file beside them.
    const bool is_text_grid = fs::path(name).extension() == ".asc";
    fail(is_text_grid
             ? "has no coordinate reference system (a file of the same name that ends in .prj gives it one: "
               "gdalsrsinfo -o wkt_esri EPSG:4326 > NAME.prj for latitudes and longitudes)"
             : "has no coordinate reference system (gdal_edit.py -a_srs EPSG:4326 sets latitudes and "
               "longitudes)");
  }
  crs.reset(OSRClone(given));
  if (const char* datum = OSRGetAttrValue(crs.get(), "VERT_CS", 0)) {
    notes.push_back(std::string("says that its heights are of '") + datum + "'");
  } else if (OSRGetAxesCount(crs.get()) == 3 && !OSRIsGeocentric(crs.get())) {
    notes.push_back("says that its heights are above the ellipsoid");
  }
  char* unit = nullptr;
  const double unit_of_plane_m = OSRIsProjected(crs.get()) ? OSRGetLinearUnits(crs.get(), &unit) : 1;
  if (!has_unit && scale == 1 && std::abs(unit_of_plane_m - 0.3048) < 1e-5) {
    warnings.push_back(std::string("its coordinates are in '") + unit +
                       "', and it has no unit of heights: they are taken as metres. If they are feet, "
                       "gdal_translate -a_scale 0.3048 makes a copy in metres");
  }
  OSRStripVertical(crs.get());
  OSRSetAxisMappingStrategy(crs.get(), OAMS_TRADITIONAL_GIS_ORDER);
  const gdal::SpatialReference wgs84(OSRNewSpatialReference(nullptr));
  OSRSetWellKnownGeogCS(wgs84.get(), "WGS84");
  OSRSetAxisMappingStrategy(wgs84.get(), OAMS_TRADITIONAL_GIS_ORDER);
  to_wgs84 = newTransformation(crs.get(), wgs84.get());
  from_wgs84 = newTransformation(wgs84.get(), crs.get());
  if (!to_wgs84 || !from_wgs84) {
    fail(messages.explain(std::string("its coordinate reference system '") + OSRGetName(crs.get()) +
                          "' cannot be brought to latitude and longitude"));
  }
  const double* g = pixel_to_crs;
  const double post = turned ? std::min(std::hypot(g[1], g[4]), std::hypot(g[2], g[5]))
                             : std::min(lattice.step_x, lattice.step_y);
  line_transformer.reset(
      GDALCreateApproxTransformer(transformPoints, from_wgs84.get(), kLineTolerance_posts * post));

  geographic = OSRIsGeographic(crs.get()) && !turned && liesOnWgs84();
  if (geographic) {
    snapToDegrees(lattice.x0, lattice.step_x, columns);
    snapToDegrees(lattice.y0, lattice.step_y, rows);
    const double west_deg = lattice.x(-0.5), east_deg = lattice.x(columns - 0.5);
    if (west_deg < -kMaxLongitude_deg || east_deg > kMaxLongitude_deg) {
      fail("its longitudes run from " + shortText(west_deg) + " to " + shortText(east_deg) +
           " deg, outside the allowed range " + shortText(-kMaxLongitude_deg) + " to " +
           shortText(kMaxLongitude_deg) + " deg");
    }
    plane_name = "WGS84";
    return;
  }
  char* wkt = nullptr;
  OSRExportToWkt(crs.get(), &wkt);
  plane_name = turned ? name : std::string(wkt ? wkt : "");
  CPLFree(wkt);
  notes.push_back(std::string("posts in ") + OSRGetName(crs.get()) + (turned ? ", turned," : "") +
                  " are brought to latitudes and longitudes of WGS84, bilinear");
}

/// True if the CRS's longitudes and latitudes differ from WGS84's by less than kSameDatum_posts.
bool TerrainFile::Impl::liesOnWgs84() const {
  std::vector<double> x, y;
  for (double part_y : {0.0, 0.5, 1.0}) {
    for (double part_x : {0.0, 0.5, 1.0}) {
      x.push_back(lattice.x(part_x * (columns - 1)));
      y.push_back(lattice.y(part_y * (rows - 1)));
    }
  }
  std::vector<double> longitude = x, latitude = y;
  transform(to_wgs84, longitude, latitude);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(std::abs(wrapLongitude_deg(longitude[k] - x[k])) <= kSameDatum_posts * lattice.step_x &&
          std::abs(latitude[k] - y[k]) <= kSameDatum_posts * lattice.step_y)) {
      return false;
    }
  }
  return true;
}

void TerrainFile::Impl::crsOfPlane(std::vector<double>& x, std::vector<double>& y) const {
  if (!turned) return;
  const double* g = pixel_to_crs;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double column = x[k] + 0.5, row = y[k] + 0.5;
    x[k] = g[0] + column * g[1] + row * g[2];
    y[k] = g[3] + column * g[4] + row * g[5];
  }
}

void TerrainFile::Impl::planeOfCrs(std::vector<double>& x, std::vector<double>& y) const {
  const double* g = pixel_to_crs;
  if (OSRIsGeographic(crs.get())) {
    // The range of longitudes that the file uses, in whole turns.
    const double turn = 2.0 * kPi / OSRGetAngularUnits(crs.get(), nullptr);
    const double middle = g[0] + 0.5 * (columns * g[1] + rows * g[2]);
    for (double& longitude : x) longitude = middle + std::remainder(longitude - middle, turn);
  }
  if (!turned) return;
  const double area = g[1] * g[5] - g[2] * g[4];
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double east = x[k] - g[0], north = y[k] - g[3];
    x[k] = (east * g[5] - north * g[2]) / area - 0.5;
    y[k] = (north * g[1] - east * g[4]) / area - 0.5;
  }
}

TerrainFile::TerrainFile(const std::string& file, const SourceLocation& location)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = file;
  impl_->location = location;
  impl_->readHead();
}
TerrainFile::~TerrainFile() = default;

const std::string& TerrainFile::name() const {
  return impl_->name;
}
const std::string& TerrainFile::format() const {
  return impl_->format;
}
std::string TerrainFile::crs() const {
  const char* authority = OSRGetAuthorityName(impl_->crs.get(), nullptr);
  const char* code = OSRGetAuthorityCode(impl_->crs.get(), nullptr);
  std::string text = OSRGetName(impl_->crs.get());
  if (authority && code) text += std::string(" (") + authority + ":" + code + ")";
  return text;
}
const std::vector<std::string>& TerrainFile::notes() const {
  return impl_->notes;
}
const PostLattice& TerrainFile::lattice() const {
  return impl_->lattice;
}
int TerrainFile::columns() const {
  return impl_->columns;
}
int TerrainFile::rows() const {
  return impl_->rows;
}
const std::vector<std::string>& TerrainFile::warnings() const {
  return impl_->warnings;
}
bool TerrainFile::isArea() const {
  return impl_->is_area;
}
bool TerrainFile::isGeographic() const {
  return impl_->geographic;
}
const std::string& TerrainFile::planeName() const {
  return impl_->plane_name;
}

void TerrainFile::read(const PostWindow& window, const RowSink& take) const {
  const GdalMessages messages;  // constructed before the dataset, whose destructor may report errors
  impl_->checkedSources();
  const gdal::Dataset dataset = impl_->open();
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  GDALRasterBandH mask_band = (GDALGetMaskFlags(band) & GMF_ALL_VALID) == 0 ? GDALGetMaskBand(band) : nullptr;
  const int columns = static_cast<int>(window.columns);
  const int left = static_cast<int>(window.first_column);
  const long long strip_rows = std::max(1LL, kStripPosts / std::max(1LL, window.columns));
  std::vector<float> strip;
  std::vector<GByte> mask;
  for (long long begin = 0; begin < window.rows; begin += strip_rows) {
    checkpoint();
    const int rows = static_cast<int>(std::min(strip_rows, window.rows - begin));
    const long long south = window.first_row + begin;
    const int top = static_cast<int>(impl_->north_first ? impl_->rows - south - rows : south);
    strip.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    mask.assign(strip.size(), 255);
    if (GDALRasterIO(band, GF_Read, left, top, columns, rows, strip.data(), columns, rows, GDT_Float32, 0,
                     0) != CE_None ||
        (mask_band != nullptr && GDALRasterIO(mask_band, GF_Read, left, top, columns, rows, mask.data(),
                                              columns, rows, GDT_Byte, 0, 0) != CE_None)) {
      impl_->fail(messages.explain("rows " + std::to_string(top) + " to " + std::to_string(top + rows - 1) +
                                   " cannot be read"));
    }
    for (std::size_t k = 0; k < strip.size(); ++k) {
      const bool declared_void = mask[k] == 0 || strip[k] == kVoidValues[0] || strip[k] == kVoidValues[1];
      const double height_m = (strip[k] * impl_->scale + impl_->offset) * impl_->unit_m;
      const bool known = !declared_void && std::abs(height_m) <= kMaxHeightOnEarth_m;
      strip[k] = known ? static_cast<float>(height_m) : std::numeric_limits<float>::quiet_NaN();
    }
    for (int row = 0; row < rows; ++row) {
      const int row_of_file = impl_->north_first ? rows - 1 - row : row;
      take(begin + row, strip.data() + static_cast<std::ptrdiff_t>(row_of_file) * columns);
    }
  }
}

void TerrainFile::toGeographic(std::vector<double>& x, std::vector<double>& y) const {
  impl_->crsOfPlane(x, y);
  transform(impl_->to_wgs84, x, y);
}

void TerrainFile::toPlane(std::vector<double>& x, std::vector<double>& y) const {
  transform(impl_->from_wgs84, x, y);
  impl_->planeOfCrs(x, y);
}

void TerrainFile::lineToPlane(std::vector<double>& x, std::vector<double>& y) const {
  const GdalMessages quiet;
  std::vector<double> z(x.size(), 0.0);
  std::vector<int> done(x.size());
  GDALApproxTransform(impl_->line_transformer.get(), FALSE, static_cast<int>(x.size()), x.data(), y.data(),
                      z.data(), done.data());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!done[k]) x[k] = y[k] = std::nan("");
  }
  impl_->planeOfCrs(x, y);
}

}  // namespace emscape::scenario
