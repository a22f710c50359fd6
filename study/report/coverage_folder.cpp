#include "study/report/coverage_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/files/file_digest.h"
#include "base/files/file_reading.h"
#include "base/files/inputs.h"
#include "base/files/json_reading.h"
#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/terrain/raster_access.h"
#include "study/maps/gdal_support.h"
#include "study/maps/surface_maps.h"

namespace emscape::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw Error(ErrorCode::bad_input, {file.string(), 0, 0}, why);
}

/// Calls a function that reads values from a report; errors name missing or wrong values.
template <class Read>
void readFrom(const fs::path& file, const Read& read) {
  readJson<Json>(readWholeText(file), file.string(), read, ": not a report of emscape coverage");
}

/// The scenario of a folder, if it and its terrain files still have their content; else a scenario with
/// only its name.
void findInputs(const Json& record, CoverageFolder& folder) {
  auto known = std::make_shared<scenario::Scenario>();
  const Json& of = record.at("scenarios").at(0);
  known->name = of.at("name");
  known->file = of.at("file");  // as it was given
  std::error_code failed;
  if (const std::string path = of.value("path", ""); fs::exists(path, failed)) known->file = path;
  known->hash = of.at("hash");
  folder.scenario = known;
  std::vector<scenario::Edit> edits;
  for (const std::string text : of.at("edits")) edits.push_back(scenario::parseEdit(text));
  std::set<std::pair<std::string, std::string>> digests;
  for (const Json& file : record.at("terrain")) digests.emplace(file.at("file"), file.at("crc32"));
  try {
    const auto scenario = scenario::loadScenario(known->file, edits, scenario::ReadFor::chosen_times);
    if (scenario->hash != known->hash) return;
    if (scenario->terrain) {
      for (const std::string& file : scenario->terrain->rasters()) {
        const std::string crc32 = fmt::format("{:08x}", digestOf(file).crc32);
        if (digests.count({fs::path(file).filename().string(), crc32}) == 0) return;
      }
    }
    MapArea area;
    area.box = {90, -90, 0, 0};
    scenario::GeoBox& box = area.box;
    const double middle_deg = folder.grid->positions[folder.grid->pixels() / 2].longitude_deg;
    double west_deg = 0, east_deg = 0;
    for (const emfield::Surface::Position& position : folder.grid->positions) {
      const double from_middle_deg = std::remainder(position.longitude_deg - middle_deg, 360.0);
      west_deg = std::min(west_deg, from_middle_deg);
      east_deg = std::max(east_deg, from_middle_deg);
      box.south_deg = std::min(box.south_deg, position.latitude_deg);
      box.north_deg = std::max(box.north_deg, position.latitude_deg);
    }
    box.west_deg = middle_deg + west_deg;
    box.east_deg = middle_deg + east_deg;
    folder.terrain = loadTerrain(*scenario, area);
    folder.scenario = scenario;
    folder.has_inputs = true;
  } catch (const Error&) {
    return;  // the folder can be read without them
  }
}

CoverageMap mapOf(const Json& record, const CoverageFolder& folder) {
  CoverageRequest request;
  request.quantity = folder.quantity;
  request.threshold = folder.threshold;
  std::optional<MapHeight> height;
  for (const auto& [key, reference] : {std::pair{"height_agl_m", emfield::HeightReference::ground},
                                       std::pair{"height_msl_m", emfield::HeightReference::mean_sea_level}}) {
    if (record.contains(key)) height = MapHeight{reference, record.at(key)};
  }
  CoverageMap map = emptyMap(*folder.scenario, request, productNamed(record.at("product")), height);
  if (record.contains("time_s")) map.time_s = record.at("time_s").get<double>();
  map.unit = record.at("unit");
  return map;
}

gdal::Dataset openGeoTiff(const scenario::GdalMessages& messages, const fs::path& file) {
  static const char* const kGeoTiff[] = {"GTiff", nullptr};
  gdal::prepare();
  if (const std::string fault = scenario::Sidecars().faultOf(file); !fault.empty()) fail(file, fault);
  gdal::Dataset dataset = gdal::openFile(file, GDAL_OF_RASTER, kGeoTiff);
  if (dataset == nullptr || GDALGetRasterCount(dataset.get()) != 1)
    fail(file, messages.explain("cannot be read as a map"));
  const std::string fault = scenario::faultOfDataset(dataset.get());
  if (!fault.empty()) fail(file, fault);
  return dataset;
}

/// Corner and cell of a GeoTIFF whose rows run to the east.
struct Pixels {
  double left_m = 0, top_m = 0, cell_m = 0;
  int width = 0, height = 0;

  explicit Pixels(const gdal::Dataset& dataset)
      : width(GDALGetRasterXSize(dataset.get())), height(GDALGetRasterYSize(dataset.get())) {
    double transform[6] = {};
    GDALGetGeoTransform(dataset.get(), transform);
    left_m = transform[0];
    cell_m = transform[1];
    top_m = transform[3];
  }
  bool operator==(const MapGrid& grid) const {
    return left_m == grid.left_m && top_m == grid.top_m && cell_m == grid.cell_m && width == grid.width &&
           height == grid.height;
  }
};

std::shared_ptr<const MapGrid> gridOf(const fs::path& file, const std::string& crs) {
  const scenario::GdalMessages messages;
  const gdal::Dataset dataset = openGeoTiff(messages, file);
  const Pixels pixels(dataset);
  OGRSpatialReferenceH reference = GDALGetSpatialRef(dataset.get());
  if (!(pixels.cell_m > 0) || reference == nullptr) fail(file, "has no projection");
  try {
    return std::make_shared<const MapGrid>(mapGridAt(wkt2Of(reference), crs, pixels.cell_m, pixels.left_m,
                                                     pixels.top_m, pixels.width, pixels.height));
  } catch (const Error& error) {
    fail(file, error.message());
  }
}

}  // namespace

CoverageFolder openCoverageFolder(const fs::path& path) {
  const WorkPart part("reading " + path.string(), 0, 0);
  CoverageFolder folder;
  folder.path = path;
  const fs::path report = path / "report.json", study = path / "study.json";
  for (const fs::path& file : {report, study}) {
    if (!inputExists(file) || !fs::is_regular_file(file)) {
      fail(file, "there is no such file: not a folder written by emscape coverage, or incomplete");
    }
  }
  readFrom(study, [&](const Json& record) {
    const std::string command = record.at("command");
    if (command != "coverage") {
      fail(study, fmt::format("the folder is of emscape {}, not of emscape coverage", command));
    }
  });
  readFrom(report, [&](const Json& json) {
    folder.quantity = scenario::quantityFromName(json.at("quantity"));
    folder.threshold = json.at("threshold");
    std::string first;
    for (const Json& map : json.at("maps")) {
      std::string geotiff;
      for (const std::string file : map.at("files")) {
        if (fs::path(file).extension() == ".tif") geotiff = file;
      }
      if (first.empty()) first = geotiff;
      folder.geotiffs.push_back(std::move(geotiff));
    }
    if (first.empty()) {
      fail(report, "the folder has no GeoTIFFs; emscape coverage writes them with --format cog");
    }
    folder.grid = gridOf(path / first, json.at("crs"));
  });
  readFrom(study, [&](const Json& record) { findInputs(record, folder); });
  readFrom(report, [&](const Json& json) {
    for (const Json& map : json.at("maps")) folder.maps.push_back(mapOf(map, folder));
  });
  return folder;
}

CoverageMap readMap(const CoverageFolder& folder, std::size_t index) {
  CoverageMap map = folder.maps[index];
  if (folder.geotiffs[index].empty()) {
    fail(folder.path / "report.json", fmt::format("has no GeoTIFF of {}", nameOf(map)));
  }
  const fs::path file = folder.path / folder.geotiffs[index];
  const scenario::GdalMessages messages;
  const gdal::Dataset dataset = openGeoTiff(messages, file);
  const MapGrid& grid = *folder.grid;
  if (!(Pixels(dataset) == grid)) fail(file, "its pixels are not those of the folder's other maps");
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  std::vector<float> values(grid.pixels());
  if (GDALRasterIO(band, GF_Read, 0, 0, grid.width, grid.height, values.data(), grid.width, grid.height,
                   GDT_Float32, 0, 0) != CE_None) {
    fail(file, messages.explain("cannot be read"));
  }
  const std::string unit = GDALGetRasterUnitType(band);
  if (unit != map.unit) {
    fail(file, fmt::format("its unit is '{}', not '{}' as in report.json", unit, map.unit));
  }
  const auto none = static_cast<float>(GDALGetRasterNoDataValue(band, nullptr));
  for (float& value : values) {
    if (value == none) value = NAN;
  }
  setValues(map, grid, std::move(values));
  return map;
}

std::string nameOf(const CoverageMap& map) {
  return fmt::format("{}{}{}", map.name, map.height ? " at " + describe(*map.height) : "",
                     map.time_s ? fmt::format(", t = {:g} s", *map.time_s) : "");
}

}  // namespace emscape::study
