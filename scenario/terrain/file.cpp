#include "scenario/terrain/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "base/files/file_reading.h"
#include "base/geodesy/gdal_file.h"
#include "base/text/shell_word.h"
#include "emscape/base/work.h"
#include "scenario/terrain/file_remedies.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/georeference.h"
#include "scenario/terrain/raster_access.h"
#include "scenario/terrain/vrt.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

/// Values that mean void in HGT and DTED whatever a file's header says.
constexpr float kVoidValues[] = {-32767.0f, -32768.0f};
constexpr long long kStripPosts = 1 << 21;
constexpr int kRowsPerSample = 4;                        ///< rows whose steps are looked at: one of these
constexpr int kMaxPostsPerAxis = 1 << 22;                ///< the whole earth in a third of an arc second
constexpr int kMinTilePosts = 2, kMaxTilePosts = 21601;  ///< of an HGT, per axis

/// Reports vertical systems of GeoTIFF 1.0, which GDAL otherwise leaves out.
class VerticalSystems {
 public:
  VerticalSystems() { CPLSetThreadLocalConfigOption(kKey, "YES"); }
  ~VerticalSystems() { CPLSetThreadLocalConfigOption(kKey, nullptr); }

 private:
  static constexpr const char* kKey = "GTIFF_REPORT_COMPD_CS";
};

/// Posts per axis of an HGT of a number of bytes; 0 if it is not square.
int tilePosts(std::uintmax_t bytes) {
  const auto posts = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes / 2))));
  const bool is_square =
      bytes == std::uintmax_t{2} * static_cast<unsigned>(posts) * static_cast<unsigned>(posts);
  return is_square && posts >= kMinTilePosts && posts <= kMaxTilePosts ? posts : 0;
}

/// True for the sizes of 3", 1", 0.5" and 1/3".
bool isKnownTile(int posts) {
  return posts == 1201 || posts == 3601 || posts == 7201 || posts == 10801;
}

/// True if GDAL reads an HGT of this name and size.
bool isStandardTile(const std::string& name, int posts) {
  const auto is = [&](std::size_t at, const char* letters) {
    return at < name.size() && std::strchr(letters, name[at]) != nullptr;
  };
  const auto digits = [&](std::size_t at, std::size_t count) {
    for (std::size_t k = at; k < at + count; ++k) {
      if (k >= name.size() || std::isdigit(static_cast<unsigned char>(name[k])) == 0) return false;
    }
    return true;
  };
  const bool is_named = is(0, "NSns") && digits(1, 2) && is(3, "EWew") && digits(4, 3) && is(7, ".");
  return (posts == 1201 || posts == 3601) && is_named && cornerInName(name).has_value();
}

/// The height in a colour.
/// The band of opacity, which GDAL takes as a mask of whole numbers only; null: there is none.
GDALRasterBandH alphaBandOf(GDALDatasetH dataset) {
  for (int n = GDALGetRasterCount(dataset); n > 1; --n) {
    GDALRasterBandH band = GDALGetRasterBand(dataset, n);
    if (GDALGetRasterColorInterpretation(band) == GCI_AlphaBand) return band;
  }
  return nullptr;
}

double decoded(HeightEncoding encoding, float red, float green, float blue) {
  const double r = static_cast<double>(red), g = static_cast<double>(green), b = static_cast<double>(blue);
  return encoding == HeightEncoding::terrarium ? r * 256 + g + b / 256 - 32768
                                               : -10000 + (r * 65536 + g * 256 + b) * 0.1;
}

}  // namespace

struct TerrainFile::Impl {
  std::string name;
  ElevationSource source;
  SourceLocation location;
  TerrainFileKeys keys;
  std::vector<std::string> notes;
  std::string format;
  int columns = 0, rows = 0;
  double scale = 1.0, offset = 0.0;
  int band = 1;
  HeightMeaning meaning;
  std::optional<Georeference> georeference;
  bool is_16_bits = false, is_real = false;  ///< type of the band; is_real: of 32 bits
  bool is_ellipsoidal = false;               ///< as its netCDF variable states
  std::string band_warning;                  ///< of bands with names
  std::string depth_name;                    ///< long name of a netCDF variable that speaks of depth
  bool is_tile = false;                      ///< an HGT that GDAL does not read by itself
  mutable std::unique_ptr<MemoryFiles> unpacked;
  mutable std::string unpacked_name;

  [[noreturn]] void fail(const std::string& problem) const {
    const std::string file = (keys.has_classes ? "land cover file " : "elevation file ") + name + ": ";
    throw Error(ErrorCode::bad_input, location, problem.rfind(file, 0) == 0 ? problem : file + problem);
  }
  /// Errors of what a function finds become those of the file.
  template <class Find>
  auto found(const Find& find) const {
    try {
      return find();
    } catch (const Error& error) {
      if (!error.location().file.empty()) throw;
      fail(error.message());
    }
  }

  std::set<fs::path> checkedSources() const;  ///< none if the file is not a VRT
  gdal::Dataset open() const;                 ///< after checkedSources()
  bool isInMemory() const { return !source.member.empty() || is_tile; }
  void unpack() const;
  std::string tileInMemory(MemoryFiles& files, std::string bytes) const;
  void checkDatasets(GDALDatasetH dataset, const std::set<fs::path>& sources) const;
  void readHead();
  void readBand(GDALDatasetH dataset);
  void readMeaningOfNetcdf(GDALRasterBandH of_heights);
  void requireClasses(GDALRasterBandH band_of_codes) const;
  void placePosts(GDALDatasetH dataset);
};

std::set<fs::path> TerrainFile::Impl::checkedSources() const {
  if (isInMemory()) return {};
  return found([&] { return sourcesOfVrt(name); });
}

/// The bytes of an HGT as a raster that GDAL reads.
std::string TerrainFile::Impl::tileInMemory(MemoryFiles& files, std::string bytes) const {
  const std::optional<TileCorner> corner = cornerInName(source.ownName());
  const int posts = tilePosts(bytes.size());
  if (const std::string foreign = foreignContent(bytes); !foreign.empty()) fail(foreign);
  if (posts == 0) {
    fail(fmt::format(
        "has {} bytes, which is no square of posts of 2 bytes as an HGT tile has (1201, 3601, 7201 or "
        "10801 posts a side); it may be cut off or of another format",
        bytes.size()));
  }
  if (!corner) fail(remedyForTileWithoutPosition());
  const double step_deg = 1.0 / (posts - 1);
  files.add("tile.hdr",
            fmt::format("NROWS {0}\nNCOLS {0}\nNBANDS 1\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER M\n"
                        "LAYOUT BIL\nULXMAP {1}\nULYMAP {2}\nXDIM {3:.17g}\nYDIM {3:.17g}\nNODATA -32768\n",
                        posts, corner->longitude_deg, corner->latitude_deg + 1, step_deg));
  files.add("tile.prj",
            "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
            "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
  return files.add("tile.bil", std::move(bytes));
}

void TerrainFile::Impl::unpack() const {
  if (unpacked) return;
  found([&] {
    auto files = std::make_unique<MemoryFiles>();
    if (is_tile) {
      unpacked_name =
          tileInMemory(*files, source.member.empty() ? readWholeText(source.file) : unpackedContent(source));
    } else {
      unpacked_name = files->unpack(source);
    }
    unpacked = std::move(files);
  });
}

gdal::Dataset TerrainFile::Impl::open() const {
  if (const std::string fault = gdal::faultOfName(source.file); !fault.empty()) fail(fault);
  const GdalMessages messages;
  const bool is_picture = keys.encoding.has_value();
  gdal::Dataset dataset;
  if (isInMemory()) {
    unpack();
    dataset = openElevationInMemory(unpacked_name, unpacked->siblings(), is_picture);
  } else {
    dataset = openElevation(name, is_picture);
  }
  if (!dataset) fail(messages.explain(faultOfUnreadable(source, is_picture)));
  return dataset;
}

void TerrainFile::Impl::checkDatasets(GDALDatasetH dataset, const std::set<fs::path>& sources) const {
  const std::string fault = faultOfDataset(dataset);
  if (!fault.empty()) fail(fault);
  std::error_code ignored;
  for (const fs::path& file : sources) {
    if (!fs::exists(file, ignored)) continue;  // GDAL reports it if its heights are read
    const GdalMessages messages;
    const gdal::Dataset opened = openElevationSource(file);
    const std::string fault_of_source =
        opened ? faultOfDataset(opened.get()) : messages.explain("cannot be read as an elevation file");
    if (!fault_of_source.empty()) fail("source " + file.string() + ": " + fault_of_source);
  }
}

void TerrainFile::Impl::readHead() {
  const GdalMessages quiet;  // constructed before the dataset, whose destructor may report errors
  const VerticalSystems vertical_systems;
  gdal::prepare();
  if (lowerEnding(source.ownName()) == ".hgt" && gdal::faultOfName(source.file).empty()) {
    std::error_code ignored;
    // The size of a packed tile is not known; by the name alone, GDAL's driver is tried where it may be
    // right.
    const int posts = source.member.empty() ? tilePosts(fs::file_size(source.file, ignored)) : 0;
    is_tile = !isStandardTile(fs::path(source.ownName()).filename().string(), posts);
  }
  const std::set<fs::path> sources = checkedSources();
  const gdal::Dataset dataset = open();
  const int bands = GDALGetRasterCount(dataset.get());
  if (bands == 0) fail(remedyForContainer(dataset.get(), source));
  GDALDriverH driver = GDALGetDatasetDriver(dataset.get());
  const char* long_name = GDALGetMetadataItem(driver, GDAL_DMD_LONGNAME, nullptr);
  format = is_tile ? "SRTMHGT File Format" : long_name ? long_name : GDALGetDriverShortName(driver);
  columns = GDALGetRasterXSize(dataset.get());
  rows = GDALGetRasterYSize(dataset.get());
  if (columns > kMaxPostsPerAxis || rows > kMaxPostsPerAxis) {
    fail("has " + std::to_string(columns) + " x " + std::to_string(rows) + " posts, more than the allowed " +
         std::to_string(kMaxPostsPerAxis) + " in a row or column");
  }
  if (keys.band > bands)
    fail(fmt::format("'band: {}' of the scenario is outside the allowed range 1 to {}, the file's bands",
                     keys.band, bands));
  band = std::max(keys.band, 1);
  if (bands > 1 && keys.band == 0 && !keys.encoding) {
    std::string names;
    for (int n = 1; n <= bands; ++n) {
      const std::string name_of_band = GDALGetDescription(GDALGetRasterBand(dataset.get(), n));
      if (!name_of_band.empty())
        names += fmt::format("{}{} '{}'", names.empty() ? "" : ", ", n, name_of_band);
    }
    const std::string text = fmt::format("has {} bands{}: heights are taken from the first", bands,
                                         names.empty() ? "" : " (" + names + ")");
    if (names.empty())
      notes.push_back(text);
    else
      band_warning = text + "; `band` of the file in the scenario chooses another";
  }
  checkDatasets(dataset.get(), sources);
  if (EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get())), "AAIGrid")) {
    std::ifstream in_folder(source.file, std::ios::binary);
    std::istringstream in_archive(source.member.empty() ? "" : unpackedContent(source));
    const std::string fault = faultOfGridLines(
        source.member.empty() ? static_cast<std::istream&>(in_folder) : in_archive, columns, rows);
    if (!fault.empty()) fail(fault);
  }
  readBand(dataset.get());
  placePosts(dataset.get());
}

void TerrainFile::Impl::readBand(GDALDatasetH dataset) {
  GDALRasterBandH of_heights = GDALGetRasterBand(dataset, band);
  if (GDALDataTypeIsComplex(GDALGetRasterDataType(of_heights))) fail("holds complex numbers, not heights");
  const GDALColorInterp colour = GDALGetRasterColorInterpretation(of_heights);
  if (keys.has_classes) {
    requireClasses(of_heights);
    return;
  }
  if (keys.encoding) {
    if (GDALGetRasterCount(dataset) < band + 2 || GDALGetRasterDataType(of_heights) != GDT_Byte)
      fail(fmt::format(
          "'encoding: {}' of the scenario needs red, green and blue as bands of bytes; the file has {} "
          "band{} of {}",
          toString(*keys.encoding), GDALGetRasterCount(dataset), GDALGetRasterCount(dataset) == 1 ? "" : "s",
          GDALGetDataTypeName(GDALGetRasterDataType(of_heights))));
    notes.push_back(fmt::format("heights are decoded from colours ({})", toString(*keys.encoding)));
  } else if (colour != GCI_Undefined && colour != GCI_GrayIndex) {
    fail(remedyForPicture(band, GDALGetColorInterpretationName(colour), GDALGetRasterCount(dataset)));
  }
  if (!keys.encoding && GDALGetRasterDataType(of_heights) == GDT_Byte && !keys.height_unit)
    fail(
        "has 8 bits for a post, as pictures, masks and classes have, but no heights. If it has heights, "
        "`height_unit: m` of the file in the scenario states it");
  is_16_bits =
      GDALGetRasterDataType(of_heights) == GDT_Int16 || GDALGetRasterDataType(of_heights) == GDT_UInt16;
  is_real = GDALGetRasterDataType(of_heights) == GDT_Float32;
  if (keys.swap_bytes && !is_16_bits && !is_real)
    fail(fmt::format(
        "'swap_bytes' of the scenario needs heights of 16 bits or real numbers of 32; the file has {}",
        GDALGetDataTypeName(GDALGetRasterDataType(of_heights))));
  scale = GDALGetRasterScale(of_heights, nullptr);
  if (scale > 0) readMeaningOfNetcdf(of_heights);
  offset = GDALGetRasterOffset(of_heights, nullptr);
  if (scale != 1.0 || offset != 0.0) {
    notes.push_back("heights are stored with scale " + std::to_string(scale) + " and offset " +
                    std::to_string(offset));
  }
}

/// What the CF conventions state of a variable, also in copies of it; a scale below 0 makes heights of
/// depths.
void TerrainFile::Impl::readMeaningOfNetcdf(GDALRasterBandH of_heights) {
  const auto attribute = [&](const char* key) {
    const char* const text = GDALGetMetadataItem(of_heights, key, nullptr);
    return std::string(text == nullptr ? "" : text);
  };
  const std::string standard_name = attribute("standard_name"), long_name = attribute("long_name");
  const bool is_depth = standard_name.find("depth") != std::string::npos;
  if (is_depth || EQUAL(attribute("positive").c_str(), "down")) {
    fail(fmt::format(
        "states depths, downwards ({}); gdal_translate -ot Float32 -a_scale -1 -a_offset 0 {} HEIGHTS.tif "
        "makes "
        "a copy of heights",
        is_depth ? "standard_name: " + standard_name : "positive: down", shellWord(source.ownName())));
  }
  is_ellipsoidal = standard_name == "height_above_reference_ellipsoid";
  if (long_name.find("depth") != std::string::npos || long_name.find("Depth") != std::string::npos)
    depth_name = long_name;
}

void TerrainFile::Impl::requireClasses(GDALRasterBandH band_of_codes) const {
  const GDALColorInterp colour = GDALGetRasterColorInterpretation(band_of_codes);
  if (colour != GCI_Undefined && colour != GCI_GrayIndex && colour != GCI_PaletteIndex)
    fail(fmt::format(
        "is a picture, not codes of land cover: its band {} is '{}'; get the raster of class codes", band,
        GDALGetColorInterpretationName(colour)));
  const GDALDataType type = GDALGetRasterDataType(band_of_codes);
  if (type == GDT_Float32 || type == GDT_Float64)
    fail(
        "holds real numbers, not codes of land cover; if they are whole, gdal_translate -ot UInt16 makes a "
        "raster of codes");
}

void TerrainFile::Impl::placePosts(GDALDatasetH dataset) {
  GdalMessages messages;
  if (const char* const product = GDALGetMetadataItem(dataset, "EMSCAPE_PRODUCT", nullptr);
      product != nullptr)
    fail(std::string("is a map of emscape ('") + product + "'), whose values are no heights");
  double transform[6];
  OGRSpatialReferenceH given = GDALGetSpatialRef(dataset);
  bool is_tile_of_web = false;
  if (GDALGetGeoTransform(dataset, transform) != CE_None) {
    is_tile_of_web = keys.encoding && webTileTransform(source.file, columns, rows, transform);
    if (!is_tile_of_web && GDALGetGCPCount(dataset) > 0)
      fail(
          fmt::format("has its position in ground control points; gdalwarp -t_srs EPSG:4326 {} HEIGHTS.tif "
                      "makes a grid of it",
                      shellWord(source.ownName())));
    const bool is_netcdf = EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset)), "netCDF");
    if (is_netcdf && GDALGetRasterCount(dataset) > 1)
      fail(fmt::format(
          "has {} layers and no georeference: a volume is not read from netCDF, but from .vdb, .nvdb, "
          ".vti and .raw",
          GDALGetRasterCount(dataset)));
    if (!is_tile_of_web) fail(remedyForNoGeoreference(source, keys.encoding.has_value()));
  }
  const char* meaning_of_pixels = GDALGetMetadataItem(dataset, GDALMD_AREA_OR_POINT, nullptr);
  const bool is_area =
      !is_tile && (meaning_of_pixels == nullptr || !EQUAL(meaning_of_pixels, GDALMD_AOP_POINT));
  found([&] { georeference.emplace(transform, columns, rows, is_area); });
  gdal::SpatialReference system;
  const bool has_system = given != nullptr && OSRGetName(given) != nullptr;
  if (!keys.crs.empty()) {
    system.reset(OSRNewSpatialReference(nullptr));
    const std::optional<int> code = epsgCodeIn(keys.crs);
    if (!code || OSRImportFromEPSG(system.get(), *code) != OGRERR_NONE)
      fail("'crs: " + keys.crs +
           "' of the scenario is not EPSG: and the number of a coordinate reference system, such "
           "as EPSG:4326 for latitudes and longitudes");
    if (has_system && !OSRIsSame(system.get(), given)) {
      gdal::SpatialReference flat(OSRClone(given));
      OSRStripVertical(flat.get());
      if (!OSRIsSame(system.get(), flat.get()))
        fail(fmt::format(
            "'crs: {}' of the scenario contradicts the file, which states '{}'. Leave out the key to use "
            "what the file states; if the file is wrong, gdal_translate -a_srs {} makes a copy",
            keys.crs, OSRGetName(given), keys.crs));
    }
  } else if (is_tile_of_web) {
    system.reset(OSRNewSpatialReference(nullptr));
    OSRImportFromEPSG(system.get(), 3857);
  } else if (has_system) {
    system.reset(OSRClone(given));
  } else {
    constexpr double kTurn_deg = 360;
    const double east = transform[0] + columns * transform[1] + rows * transform[2];
    fail(remedyForNoSystem(std::max(std::abs(transform[0]), std::abs(east)) > kTurn_deg));
  }
  HeightFacts facts{name,
                    source.ownName(),
                    GDALGetDriverShortName(GDALGetDatasetDriver(dataset)),
                    GDALGetRasterUnitType(GDALGetRasterBand(dataset, band)),
                    scale,
                    has_system ? given : system.get(),
                    keys,
                    is_ellipsoidal};
  if (is_tile) facts.driver = "SRTMHGT";
  if (facts.band_unit.empty() && source.member.empty()) facts.band_unit = heightUnitBeside(source.file);
  if (keys.has_classes) facts.band_unit = "m";
  if (facts.driver == "SRTMHGT" || keys.encoding) facts.band_unit = "m";
  meaning = found([&] { return heightMeaningOf(facts); });
  notes.insert(notes.end(), meaning.notes.begin(), meaning.notes.end());
  if (!band_warning.empty()) meaning.warnings.push_back(band_warning);
  if (!depth_name.empty())
    meaning.warnings.push_back(
        fmt::format("its variable is named '{}': if it has depths, downwards, ground is above the sea; "
                    "gdal_translate -ot "
                    "Float32 -a_scale -1 -a_offset 0 {} HEIGHTS.tif makes a copy of heights",
                    depth_name, shellWord(source.ownName())));
  if (is_tile && !isKnownTile(columns))
    meaning.warnings.push_back(fmt::format(
        "has {} bytes, {} posts a side, {} in a degree: HGT tiles have 1201, 3601, 7201 or 10801 a side. If "
        "the file is cut off, its heights are at wrong positions; get it again",
        2LL * columns * columns, columns, columns - 1));
  OSRStripVertical(system.get());
  found([&] { georeference->placeOnEarth(std::move(system), name); });
  if (!georeference->is_geographic)
    notes.push_back(std::string("posts in ") + OSRGetName(georeference->system()) +
                    (georeference->turned ? ", turned," : "") +
                    " are brought to latitudes and longitudes of WGS84, bilinear");
}

TerrainFile::TerrainFile(const ElevationSource& source, const SourceLocation& location,
                         const TerrainFileKeys& keys)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = source.name();
  impl_->source = source;
  impl_->location = location;
  impl_->keys = keys;
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
  OGRSpatialReferenceH system = impl_->georeference->system();
  const char* authority = OSRGetAuthorityName(system, nullptr);
  const char* code = OSRGetAuthorityCode(system, nullptr);
  std::string text = OSRGetName(system);
  if (authority && code) text += std::string(" (") + authority + ":" + code + ")";
  return text;
}
const std::vector<std::string>& TerrainFile::notes() const {
  return impl_->notes;
}
const std::vector<std::string>& TerrainFile::warnings() const {
  return impl_->meaning.warnings;
}
const HeightMeaning& TerrainFile::meaning() const {
  return impl_->meaning;
}
const SourceLocation& TerrainFile::location() const {
  return impl_->location;
}
const TerrainFileKeys& TerrainFile::keys() const {
  return impl_->keys;
}
const PostLattice& TerrainFile::lattice() const {
  return impl_->georeference->lattice;
}
int TerrainFile::columns() const {
  return impl_->columns;
}
int TerrainFile::rows() const {
  return impl_->rows;
}
bool TerrainFile::isArea() const {
  return impl_->georeference->is_area;
}
bool TerrainFile::isGeographic() const {
  return impl_->georeference->is_geographic;
}
const std::string& TerrainFile::planeName() const {
  return impl_->georeference->plane_name;
}
void TerrainFile::release() const {
  impl_->unpacked.reset();
}

HeightTally TerrainFile::read(const PostWindow& window, const RowSink& take) const {
  const Georeference& georeference = *impl_->georeference;
  const GdalMessages messages;  // constructed before the dataset, whose destructor may report errors
  impl_->checkedSources();
  const gdal::Dataset dataset = impl_->open();
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), impl_->band);
  const bool swaps = impl_->keys.swap_bytes;
  int has_void_value = 0;
  const double void_value = GDALGetRasterNoDataValue(band, &has_void_value);
  // GDAL's mask is of the values before their bytes are exchanged.
  GDALRasterBandH mask_band =
      (GDALGetMaskFlags(band) & GMF_ALL_VALID) == 0 && !swaps ? GDALGetMaskBand(band) : nullptr;
  if (mask_band == nullptr) mask_band = alphaBandOf(dataset.get());
  HeightTally tally;
  const int columns = static_cast<int>(window.columns);
  const int left = static_cast<int>(window.first_column);
  const long long strip_rows = std::max(1LL, kStripPosts / std::max(1LL, window.columns));
  std::vector<float> strip;
  std::vector<GByte> mask;
  std::vector<std::uint8_t> is_known;
  for (long long begin = 0; begin < window.rows; begin += strip_rows) {
    checkpoint();
    const int rows = static_cast<int>(std::min(strip_rows, window.rows - begin));
    const long long south = window.first_row + begin;
    const int top = static_cast<int>(georeference.north_first ? impl_->rows - south - rows : south);
    strip.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    mask.assign(strip.size(), 255);
    if (GDALRasterIO(band, GF_Read, left, top, columns, rows, strip.data(), columns, rows, GDT_Float32, 0,
                     0) != CE_None ||
        (mask_band != nullptr && GDALRasterIO(mask_band, GF_Read, left, top, columns, rows, mask.data(),
                                              columns, rows, GDT_Byte, 0, 0) != CE_None)) {
      impl_->fail(messages.explain("rows " + std::to_string(top) + " to " + std::to_string(top + rows - 1) +
                                   " cannot be read"));
    }
    if (impl_->keys.encoding) {
      std::vector<float> green(strip.size()), blue(strip.size());
      for (auto [next, values] : {std::pair{1, &green}, std::pair{2, &blue}}) {
        if (GDALRasterIO(GDALGetRasterBand(dataset.get(), impl_->band + next), GF_Read, left, top, columns,
                         rows, values->data(), columns, rows, GDT_Float32, 0, 0) != CE_None)
          impl_->fail(messages.explain("rows " + std::to_string(top) + " cannot be read"));
      }
      for (std::size_t k = 0; k < strip.size(); ++k)
        strip[k] = static_cast<float>(decoded(*impl_->keys.encoding, strip[k], green[k], blue[k]));
    }
    is_known.assign(strip.size(), 1);
    for (std::size_t k = 0; k < strip.size(); ++k) {
      if (swaps) {
        strip[k] = impl_->is_real ? withSwappedBytesOfReal(strip[k]) : withSwappedBytes(strip[k]);
        if (has_void_value != 0 && static_cast<double>(strip[k]) == void_value) mask[k] = 0;
      }
      is_known[k] =
          mask[k] != 0 && strip[k] != kVoidValues[0] && strip[k] != kVoidValues[1] && std::isfinite(strip[k]);
    }
    for (int row = 0; impl_->is_16_bits && row < rows; row += kRowsPerSample)
      tally.addSteps(strip, is_known, static_cast<std::size_t>(row) * static_cast<std::size_t>(columns),
                     static_cast<std::size_t>(columns));
    for (std::size_t k = 0; impl_->is_real && k < strip.size(); ++k) {
      if (is_known[k] != 0) tally.addReal(strip[k]);
    }
    for (std::size_t k = 0; k < strip.size(); ++k) {
      const double height_m = (strip[k] * impl_->scale + impl_->offset) * impl_->meaning.unit_m;
      strip[k] = is_known[k] != 0 && tally.add(height_m) ? static_cast<float>(height_m)
                                                         : std::numeric_limits<float>::quiet_NaN();
    }
    for (int row = 0; row < rows; ++row) {
      const int row_of_file = georeference.north_first ? rows - 1 - row : row;
      take(begin + row, strip.data() + static_cast<std::ptrdiff_t>(row_of_file) * columns);
    }
  }
  return tally;
}

void TerrainFile::toGeographic(std::vector<double>& x, std::vector<double>& y) const {
  impl_->georeference->toGeographic(x, y);
}

void TerrainFile::toPlane(std::vector<double>& x, std::vector<double>& y) const {
  impl_->georeference->toPlane(x, y);
}

void TerrainFile::lineToPlane(std::vector<double>& x, std::vector<double>& y) const {
  impl_->georeference->lineToPlane(x, y);
}

}  // namespace emscape::scenario
