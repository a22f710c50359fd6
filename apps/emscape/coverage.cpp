/// emscape coverage: maps of coverage at heights above ground or sea.
#include "emscape/study/coverage.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/emscape/command.h"
#include "apps/emscape/console.h"
#include "apps/emscape/interrupt.h"
#include "apps/emscape/target.h"
#include "apps/emscape/version.h"
#include "base/whole_file.h"
#include "emscape/base/log.h"
#include "emscape/scenario/scenario_file.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/study/geotiff.h"
#include "emscape/study/map_picture.h"

namespace emscape::app {
namespace {

struct CoverageCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string folder;
  std::string heights = "agl:150";
  std::vector<std::string> products{"covered", "value"};
  std::string quantity = "detection_probability";
  double threshold = NAN;
  std::string times = "0";
  double cell_m = NAN;
  std::string area;
  std::string crs = "utm";
  std::vector<std::string> formats{"cog", "png"};
};

std::string timeName(double time_s) {
  return fmt::format("t{}s", time_s);
}

/// PRODUCT_HEIGHT[_TIME]
std::string fileNameOf(const study::CoverageMap& map) {
  std::string name = study::info(map.product).name;
  if (map.height) name += "_" + study::nameOf(*map.height);
  if (map.time_s) name += "_" + timeName(*map.time_s);
  return name;
}

Json toJson(const study::CoverageMap& map, const std::vector<std::string>& files) {
  Json json{{"product", study::info(map.product).name},
            {"files", files},
            {"description", map.description},
            {"unit", map.unit}};
  if (map.height) {
    const bool above_ground = map.height->reference == emfield::HeightReference::ground;
    json[above_ground ? "height_agl_m" : "height_msl_m"] = map.height->metres;
  }
  if (map.time_s) json["time_s"] = *map.time_s;
  float least = INFINITY, largest = -INFINITY;
  for (const float value : map.values) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  json["min"] = number(static_cast<double>(least));
  json["max"] = number(static_cast<double>(largest));
  json["known_area_km2"] = map.known_area_m2 / 1e6;
  if (study::info(map.product).area_class >= 0) json["area_km2"] = map.class_area_m2 / 1e6;
  return json;
}

void printRow(const study::CoverageMap& map, const std::string& file) {
  const std::string time = map.time_s ? fmt::format("{}", *map.time_s) : "all";
  const bool is_area = study::info(map.product).area_class >= 0;
  const std::string area = !is_area ? ""
                                    : fmt::format("{:.1f} km2, {:.1f} %", map.class_area_m2 / 1e6,
                                                  100 * map.class_area_m2 / std::max(map.known_area_m2, 1.0));
  print("  {:<16} {:<26} {:>8}  {:<24} {}\n", study::info(map.product).name,
        map.height ? study::describe(*map.height) : "", time, area, file);
}

int coverage(const CoverageCommand& command, const GlobalOptions& global) {
  const auto scenario = scenario::loadScenario(command.scenario, command.edits);
  study::CoverageRequest request;
  request.heights = study::parseHeights(command.heights);
  for (const std::string& name : command.products) request.products.push_back(study::productNamed(name));
  request.quantity = scenario::quantityFromName(command.quantity);
  const std::optional<double> usual = study::defaultThreshold(request.quantity);
  const bool needs_threshold =
      std::any_of(request.products.begin(), request.products.end(),
                  [](study::Product product) { return product != study::Product::value; });
  if (std::isnan(command.threshold) && !usual && needs_threshold) {
    throw Error(ErrorCode::usage, fmt::format("--threshold: quantity '{}' has no usual one; give it in {}",
                                              command.quantity, scenario::info(request.quantity).unit));
  }
  request.threshold = std::isnan(command.threshold) ? usual.value_or(0) : command.threshold;
  request.times_s = scenario::parseTimes(command.times, scenario->clock);

  const study::MapArea area =
      command.area.empty() ? study::areaOf(scenario->region) : study::parseArea(command.area);
  const scenario::Region& region = scenario->region;
  const double usual_cell_m = std::max(1.0, std::round(region.size_m.x / region.dims.x));
  const study::MapGrid grid =
      study::makeMapGrid(area, std::isnan(command.cell_m) ? usual_cell_m : command.cell_m, command.crs);
  const scenario::TerrainPtr terrain = study::loadTerrain(*scenario, area);

  const std::filesystem::path folder = command.folder, maps = folder / "maps";
  std::error_code failed;
  std::filesystem::create_directories(maps, failed);
  if (failed) {
    throw Error(ErrorCode::other,
                fmt::format("{}: the folder cannot be made ({})", maps.string(), failed.message()));
  }
  const FolderLock lock(folder, ".coverage.lock");

  Json report{{"emscape", kVersion},          {"scenario", scenario->name},
              {"file", scenario->file},       {"scenario_hash", scenario->hash},
              {"quantity", command.quantity}, {"threshold", request.threshold},
              {"radar_look", "target"},       {"crs", grid.crs},
              {"cell_m", grid.cell_m},        {"pixels", {grid.width, grid.height}},
              {"area_weights", "ellipsoid"}};
  std::vector<std::string> emitters;
  for (const scenario::Emitter& emitter : scenario->emitters) emitters.push_back(emitter.name);
  report["emitters"] = emitters;
  report["maps"] = Json::array();
  if (!global.json) {
    print("Coverage of {}: {} x {} pixels of {} m in {}, {} >= {}\n", scenario->name, grid.width, grid.height,
          grid.cell_m, grid.crs, command.quantity, request.threshold);
  }
  const auto has = [&](const char* format) {
    return std::find(command.formats.begin(), command.formats.end(), format) != command.formats.end();
  };
  study::MapPictureOptions picture;
  picture.labels = emitters;
  if (has("png") && terrain != nullptr) picture.ground_msl_m = study::groundOf(grid, *terrain);
  const auto take = [&](study::CoverageMap map) {
    stopIfInterrupted();
    const std::string name = fileNameOf(map);
    std::vector<std::string> files;
    std::vector<std::pair<std::string, std::string>> metadata{
        {"EMSCAPE_SCENARIO", scenario->name},
        {"EMSCAPE_SCENARIO_HASH", scenario->hash},
        {"EMSCAPE_PRODUCT", study::info(map.product).name},
        {"EMSCAPE_QUANTITY", command.quantity},
        {"EMSCAPE_THRESHOLD", fmt::format("{}", request.threshold)},
        {"EMSCAPE_HEIGHT_DATUM", "EGM96 (EPSG:5773)"},
        {"EMSCAPE_VERSION", kVersion}};
    if (map.height) metadata.emplace_back("EMSCAPE_HEIGHT", study::describe(*map.height));
    if (map.time_s) metadata.emplace_back("EMSCAPE_TIME_S", fmt::format("{}", *map.time_s));
    if (has("cog")) {
      files.push_back("maps/" + name + ".tif");
      study::writeGeoTiff(folder / files.back(), grid, map,
                          map.product == study::Product::best ? emitters : std::vector<std::string>{},
                          metadata);
    }
    if (has("png")) {
      files.push_back("maps/" + name + ".png");
      const double time_s = map.time_s.value_or(request.times_s.front());
      picture.title = fmt::format("{}: {}", scenario->name, map.description);
      picture.subtitle = map.time_s
                             ? fmt::format("t = {} s", time_s)
                             : fmt::format("t = {} to {} s", request.times_s.front(), request.times_s.back());
      picture.markers = study::markersOf(scenario::snapshotAt(scenario, terrain.get(), time_s));
      render::writePng(folder / files.back(), study::drawMap(grid, map, picture));
    }
    report["maps"].push_back(toJson(map, files));
    if (!global.json) printRow(map, files.empty() ? "" : files.front());
  };
  const ProgressSink show = progressSink(global);
  const std::vector<std::string> warnings = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    return study::computeCoverage(scenario, terrain, grid, request, target.fieldOptions(), take,
                                  [&](const std::string& step, double fraction) {
                                    stopIfInterrupted();
                                    show(step, fraction);
                                  });
  });
  logWarnings(warnings);
  report["warnings"] = joinedWarnings(warnings);
  writeWhole(folder / "report.json", [&](std::ostream& out) { out << report.dump(2) << "\n"; });
  if (global.json) printJson(report);
  return 0;
}

}  // namespace

void addCoverage(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "coverage",
      "Maps of what radars detect, or of any quantity, at heights above ground or sea, as GeoTIFF");
  command->fallthrough();
  std::string products;
  for (const study::ProductInfo& entry : study::productTable()) {
    products += fmt::format("  {:<16} {}\n", entry.name, entry.description);
  }
  command->footer(fmt::format(R"(
Each pixel is computed at its centre, on the surface itself, and equals `emscape profile` there. A height above ground follows the
ground; pixels below ground, without terrain or beyond the area hold no value. Radars look at the target, wherever their scan
points. A place is covered where the quantity is at or above --threshold.

Products:
{}
DIR/maps holds a cloud-optimised GeoTIFF and a picture of each map, DIR/report.json their areas and ranges.

Examples:
  emscape coverage scenarios/jacksboro.yaml -o out --heights agl:30,150,300
  emscape coverage scenarios/jacksboro.yaml -o out --heights "agl:150;msl:1000:3000:500" --products covered,count,best
  emscape coverage scenarios/jamming.yaml -o out --products min_height,jam_loss --cell 100 --format png
  emscape coverage scenarios/jacksboro.yaml -o out --times 0:120:5 --products fraction,first_detection,longest_gap
  emscape coverage scenarios/jacksboro.yaml -o out --quantity power_density_dbwm2 --threshold -60 --area 36.3,-84.2,8000)",
                              products));
  auto options = std::make_shared<CoverageCommand>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("-o,--output", options->folder, "Folder to write")->required();
  command->add_option(
      "--heights", options->heights,
      "Heights in metres above ground (agl:) and above mean sea level (msl:): agl:30,150;msl:500:3000:500");
  addListOption(*command, "--products", options->products, "Products, with commas between them; see below");
  command->add_option("--quantity", options->quantity,
                      "A quantity of the field; see docs/scenario-format.md");
  command
      ->add_option(
          "--threshold", options->threshold,
          "Level at which a place is covered; default: 0.5 of detection_probability, 0 dB of a margin")
      ->default_str("");
  command->add_option("--times", options->times, "BEGIN:END:STEP, BEGIN:END or T, in seconds");
  command->add_option("--cell", options->cell_m, "Side of a pixel (m); default: the scenario's voxels")
      ->default_str("");
  command->add_option(
      "--area", options->area,
      "LATITUDE,LONGITUDE,RADIUS_M or bbox:WEST,SOUTH,EAST,NORTH (deg); default: the scenario's region");
  command->add_option(
      "--crs", options->crs,
      "Projection: utm (zone of the area's middle), local (azimuthal equidistant) or EPSG:NUMBER");
  addListOption(*command, "--format", options->formats, "Files of each map, with commas between them")
      ->check(CLI::IsMember({"cog", "png"}));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return coverage(*options, global); }; });
}

}  // namespace emscape::app
