#include "scenario/terrain/raster_access.h"

#include <fmt/format.h>

#include "base/geodesy/gdal_file.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

constexpr double kMebibyte = 1 << 20;
constexpr double kMaxBlockBytes = 256 * kMebibyte;
constexpr int kMaxListedFiles = 1000;  ///< GDAL looks for sidecars in any case of letters up to this number

/// The first one is for pictures whose colours encode heights.
constexpr const char* kElevationDrivers[] = {"PNG",  "GTiff", "SRTMHGT", "DTED", "VRT",  "AAIGrid", "USGSDEM",
                                             "EHdr", "HFA",   "netCDF",  "XYZ",  "GPKG", nullptr};
constexpr const char* const* kWithoutPictures = kElevationDrivers + 1;
constexpr const char* kNoSiblings[] = {nullptr};

/// @param siblings  names of other files of its folder; null: GDAL lists the folder
gdal::Dataset open(const std::string& file, const char* const* siblings, bool with_pictures = false) {
  return gdal::openFile(file, GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR,
                        with_pictures ? kElevationDrivers : kWithoutPictures, nullptr, siblings);
}

/// The driver that GDAL takes for a file if all are allowed; empty if there is none.
std::string driverOf(const std::string& file, const char* const* siblings) {
  GDALDriverH driver = GDALIdentifyDriverEx(gdal::localName(file).c_str(), GDAL_OF_RASTER, nullptr, siblings);
  return driver == nullptr ? "" : GDALGetDriverShortName(driver);
}

bool isElevationDriver(const std::string& name) {
  for (const char* const* known = kWithoutPictures; *known != nullptr; ++known) {
    if (name == *known) return true;
  }
  return false;
}

bool isSidecarEnding(const std::string& ending) {
  return EQUAL(ending.c_str(), ".ovr") || EQUAL(ending.c_str(), ".msk");
}

/// True for RASTER.ovr, RASTER.msk, RASTER.msk.ovr and so on, in any case of letters.
bool isSidecarOf(const std::string& name, const std::string& raster) {
  if (name.size() <= raster.size() || !EQUALN(name.c_str(), raster.c_str(), raster.size())) return false;
  for (std::size_t at = raster.size(); at < name.size(); at += 4) {
    if (!isSidecarEnding(name.substr(at, 4))) return false;
  }
  return true;
}

/// @param interleaved_bands  number of bands that one block holds
std::string faultOfBlock(GDALRasterBandH band, int interleaved_bands) {
  int columns = 0, rows = 0;
  GDALGetBlockSize(band, &columns, &rows);
  const double bytes =
      1.0 * GDALGetDataTypeSizeBytes(GDALGetRasterDataType(band)) * columns * rows * interleaved_bands;
  if (bytes <= kMaxBlockBytes) return "";
  return fmt::format(
      "its blocks of {} x {} values{} take {:.0f} MiB each, more than the allowed {:.0f} MiB; "
      "gdal_translate -b 1 -co TILED=YES writes smaller ones",
      columns, rows, interleaved_bands > 1 ? fmt::format(" in {} bands", interleaved_bands) : "",
      bytes / kMebibyte, kMaxBlockBytes / kMebibyte);
}

}  // namespace

gdal::Dataset openElevation(const std::string& file, bool with_pictures) {
  return open(file, nullptr, with_pictures);
}

gdal::Dataset openElevationInMemory(const std::string& name, const std::vector<const char*>& siblings,
                                    bool with_pictures) {
  return gdal::openInMemory(name, GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR,
                            with_pictures ? kElevationDrivers : kWithoutPictures, siblings.data());
}

std::string elevationFormats() {
  return "GeoTIFF, HGT, DTED, VRT, ASCII grid, USGS DEM, ESRI BIL, Erdas Imagine, netCDF, XYZ, GeoPackage";
}

std::string otherFormatOf(const std::string& file) {
  GDALDriverH driver = GDALIdentifyDriverEx(gdal::localName(file).c_str(), GDAL_OF_RASTER, nullptr, nullptr);
  if (driver == nullptr || isElevationDriver(GDALGetDriverShortName(driver))) return "";
  const char* const name = GDALGetMetadataItem(driver, GDAL_DMD_LONGNAME, nullptr);
  return fmt::format("{} ({})", GDALGetDriverShortName(driver), name == nullptr ? "" : name);
}

gdal::Dataset openElevationSource(const std::string& file) {
  for (const char* const* siblings :
       {static_cast<const char* const*>(kNoSiblings), static_cast<const char* const*>(nullptr)}) {
    const std::string driver = driverOf(file, siblings);
    if (isElevationDriver(driver)) return open(file, siblings);
    if (!driver.empty()) {
      CPLError(CE_Failure, CPLE_AppDefined, "its format is %s", driver.c_str());
      return nullptr;
    }
  }
  CPLError(CE_Failure, CPLE_AppDefined, "its format is not known");
  return nullptr;
}

const Sidecars::Listing& Sidecars::listingOf(const fs::path& folder) {
  const auto [at, is_new] = folders_.try_emplace(folder);
  Listing& listing = at->second;
  if (!is_new) return listing;
  int files = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (++files > kMaxListedFiles) {
      listing.is_complete = false;
      break;
    }
    if (isSidecarEnding(entry.path().extension())) listing.names.push_back(entry.path().filename());
  }
  return listing;
}

std::string Sidecars::faultOf(const fs::path& raster) {
  const fs::path folder = raster.has_parent_path() ? raster.parent_path() : ".";
  const Listing& listing = listingOf(folder);
  std::vector<std::string> sidecars;
  for (const std::string& name : listing.names) {
    if (isSidecarOf(name, raster.filename())) sidecars.push_back(name);
  }
  std::error_code ignored;
  for (const char* ending : {".ovr", ".OVR", ".msk", ".MSK", ".msk.ovr", ".ovr.msk"}) {
    const std::string name = raster.filename().string() + ending;
    if (!listing.is_complete && fs::exists(folder / name, ignored)) sidecars.push_back(name);
  }
  for (const std::string& name : sidecars) {
    if (driverOf(folder / name, kNoSiblings) == "GTiff") continue;
    return fmt::format("{}, which GDAL reads with it, is not a GeoTIFF; remove it", (folder / name).string());
  }
  return "";
}

namespace {

/// An Erdas Imagine file may name others that hold its values.
std::string faultOfNamedFiles(GDALDatasetH dataset) {
  if (!EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset)), "HFA")) return "";
  const gdal::Owned<CSLDestroy> files(GDALGetFileList(dataset));
  char** at = files.get();
  if (at == nullptr || *at == nullptr) return "";
  const fs::path folder = fs::path(*at).parent_path().lexically_normal();
  for (; *at != nullptr; ++at) {
    if (fs::path(*at).lexically_normal().parent_path() != folder)
      return fmt::format("it names {}, which is not in its own folder", *at);
  }
  return "";
}

}  // namespace

std::string faultOfDataset(GDALDatasetH dataset) {
  if (std::string fault = faultOfNamedFiles(dataset); !fault.empty()) return fault;
  const char* const other_files[][2] = {{"OVERVIEW_FILE", "OVERVIEWS"}, {"FILENAME", "ProxyOverviewRequest"}};
  for (const auto& [key, domain] : other_files) {
    const char* const file = GDALGetMetadataItem(dataset, key, domain);
    if (file != nullptr) return fmt::format("its metadata names a file of overviews, '{}'", file);
  }
  GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
  if (band == nullptr) return "";
  const char* interleave = GDALGetMetadataItem(dataset, "INTERLEAVE", "IMAGE_STRUCTURE");
  const bool by_pixel = interleave != nullptr && EQUAL(interleave, "PIXEL");
  const std::string fault = faultOfBlock(band, by_pixel ? GDALGetRasterCount(dataset) : 1);
  return fault.empty() ? faultOfBlock(GDALGetMaskBand(band), 1) : fault;
}

}  // namespace emscape::scenario
