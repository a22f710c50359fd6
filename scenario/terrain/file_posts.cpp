/// The posts of an elevation file on the earth, and what its heights mean.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/shell_word.h"
#include "scenario/terrain/file_impl.h"
#include "scenario/terrain/file_remedies.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

/// True for the sizes of 3", 1", 0.5" and 1/3".
bool isKnownTile(int posts) {
  return posts == 1201 || posts == 3601 || posts == 7201 || posts == 10801;
}

}  // namespace

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
    fail(remedyForNoSystem(source, keys.has_classes,
                           std::max(std::abs(transform[0]), std::abs(east)) > kTurn_deg));
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

}  // namespace emscape::scenario
