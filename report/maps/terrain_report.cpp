#include "report/maps/terrain_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "emscape/base/units.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/map_grid.h"
#include "report/json.h"
#include "report/text.h"
#include "study/picture/map_picture.h"

namespace emscape::report {
namespace {

using scenario::GeoBox;
using scenario::TerrainFileInfo;

constexpr double kMetresPerDegree = 111132;
constexpr std::size_t kMaxNamedFiles = 14;  ///< with a colour each; more are coloured by kind

double spacing_m(const TerrainFileInfo& file) {
  const double middle_deg = 0.5 * (file.box.south_deg + file.box.north_deg);
  return kMetresPerDegree *
         std::max(file.post_spacing_lat_deg, file.post_spacing_lon_deg * std::cos(degToRad(middle_deg)));
}

Json boxJson(const GeoBox& box) {
  return {{"south_deg", box.south_deg},
          {"north_deg", box.north_deg},
          {"west_deg", box.west_deg},
          {"east_deg", box.east_deg}};
}

std::string boxText(const GeoBox& box) {
  return fmt::format("latitudes {:.5f} to {:.5f}, longitudes {:.5f} to {:.5f} deg", box.south_deg, box.north_deg,
                     box.west_deg, box.east_deg);
}

bool contains(const GeoBox& box, double latitude_deg, double longitude_deg) {
  const double middle_deg = 0.5 * (box.west_deg + box.east_deg);
  return latitude_deg >= box.south_deg && latitude_deg <= box.north_deg &&
         std::abs(wrapLongitude_deg(longitude_deg - middle_deg)) <= 0.5 * (box.east_deg - box.west_deg);
}

/// Name, spacing and datum; of many files the kind only.
std::string labelOf(const TerrainFileInfo& file, bool is_named) {
  const std::string datum = file.vertical_datum.substr(0, file.vertical_datum.find(':'));
  const std::string kind = fmt::format("{:.0f} m, {}{}", spacing_m(file), datum,
                                       datum.find('(') != std::string::npos && datum.back() != ')' ? ")" : "");
  return (is_named ? std::filesystem::path(file.file).filename().string() : file.format) + ": " + kind;
}

/// Categories: "no file", "void", then the files or their kinds.
study::Map sourcesMap(const TerrainReport& report, const study::MapGrid& grid) {
  study::Map map;
  map.name = "terrain";
  map.kind = study::MapKind::category;
  map.title = "source of the ground";
  map.labels = {"void in the files", "no file"};
  std::vector<const TerrainFileInfo*> finest_first;
  for (const TerrainFileInfo& file : report.files) {
    if (file.is_needed) finest_first.push_back(&file);
  }
  std::stable_sort(finest_first.begin(), finest_first.end(),
                   [](const auto* a, const auto* b) { return spacing_m(*a) < spacing_m(*b); });
  std::vector<int> categories;
  std::map<std::string, int> of_label;
  for (const TerrainFileInfo* file : finest_first) {
    const std::string label = labelOf(*file, finest_first.size() <= kMaxNamedFiles);
    const auto [known, is_new] = of_label.emplace(label, static_cast<int>(map.labels.size()));
    if (is_new) map.labels.push_back(label);
    categories.push_back(known->second);
  }
  for (const emfield::Surface::Position& at : grid.positions) {
    int category = 1;
    for (std::size_t k = 0; k < finest_first.size() && category == 1; ++k) {
      if (contains(finest_first[k]->box, at.latitude_deg, at.longitude_deg)) category = categories[k];
    }
    const bool is_known =
        !std::isnan(at.latitude_deg) && !std::isnan(report.terrain->heightMsl_m(at.latitude_deg, at.longitude_deg));
    map.values.push_back(static_cast<float>(is_known || category == 1 ? category : 0));
  }
  return map;
}

GeoBox around(const std::vector<TerrainFileInfo>& files) {
  GeoBox all = files.front().box;
  for (const TerrainFileInfo& file : files) {
    all = {std::min(all.south_deg, file.box.south_deg), std::max(all.north_deg, file.box.north_deg),
           std::min(all.west_deg, file.box.west_deg), std::max(all.east_deg, file.box.east_deg)};
  }
  const double width_deg = std::min(all.east_deg - all.west_deg, 360.0);
  all.west_deg = wrapLongitude_deg(all.west_deg);
  all.east_deg = all.west_deg + width_deg;
  return all;
}

std::string postsText(const TerrainFileInfo& file) {
  return fmt::format("{} x {} posts, {:.6g} x {:.6g} arc seconds ({:.4g} m)", file.columns, file.rows,
                     3600 * file.post_spacing_lat_deg, 3600 * file.post_spacing_lon_deg, spacing_m(file));
}

void addFile(Text& out, const TerrainFileInfo& file) {
  out.add("{}\n", file.file);
  out.add("  format   {}; {}\n", file.format, postsText(file));
  out.add("  position {}; {}\n", file.crs, boxText(file.box));
  out.add("  datum    {}; unit {}\n", file.vertical_datum, file.height_unit);
  if (file.is_needed) {
    out.add("  heights  {}, {} void post{}\n",
            std::isnan(file.lowest_m) ? std::string("none known")
                                      : fmt::format("{:.1f} to {:.1f} m", file.lowest_m, file.highest_m),
            file.void_posts, file.void_posts == 1 ? "" : "s");
  } else {
    out.add("  not used: outside the needed area\n");
  }
  for (const std::string& note : file.notes) out.add("  note     {}\n", note);
  for (const std::string& warning : file.warnings) out.add("  assumed  {}\n", warning);
}

}  // namespace

TerrainReport terrainReport(const scenario::TerrainSpec& spec) {
  TerrainReport report;
  report.files = scenario::Terrain::describeAll(spec, nullptr);
  report.needed = around(report.files);
  report.terrain = scenario::Terrain::load(spec, report.needed);
  return report;
}

TerrainReport terrainReport(const scenario::Scenario& scenario) {
  if (!scenario.terrain)
    throw Error(ErrorCode::bad_input, {scenario.file, 0, 0}, "the scenario names no elevation files (terrain.files)");
  TerrainReport report;
  report.needed = scenario::terrainBox(scenario);
  report.files = scenario::Terrain::describeAll(*scenario.terrain, &report.needed);
  report.terrain = scenario::Terrain::load(*scenario.terrain, report.needed);
  return report;
}

Json toJson(const TerrainReport& report) {
  Json files = Json::array();
  for (const TerrainFileInfo& file : report.files) {
    files.push_back({{"file", file.file},
                     {"format", file.format},
                     {"columns", file.columns},
                     {"rows", file.rows},
                     {"post_spacing_lat_deg", file.post_spacing_lat_deg},
                     {"post_spacing_lon_deg", file.post_spacing_lon_deg},
                     {"spacing_m", spacing_m(file)},
                     {"crs", file.crs},
                     {"vertical_datum", file.vertical_datum},
                     {"height_unit", file.height_unit},
                     {"box", boxJson(file.box)},
                     {"used", file.is_needed},
                     {"lowest_m", number(file.lowest_m)},
                     {"highest_m", number(file.highest_m)},
                     {"void_posts", file.is_needed ? Json(file.void_posts) : Json(nullptr)},
                     {"notes", file.notes},
                     {"warnings", file.warnings}});
  }
  const scenario::Terrain& terrain = *report.terrain;
  return {{"files", files},
          {"area", boxJson(report.needed)},
          {"lowest_msl_m", number(terrain.lowest_m())},
          {"highest_msl_m", number(terrain.highest_m())},
          {"post_spacing_m", number(terrain.postSpacing_m())},
          {"void_posts", terrain.voidPosts()},
          {"uncovered_percent", 100 * terrain.uncoveredFraction()},
          {"warnings", terrain.warnings()}};
}

std::string terrainText(const TerrainReport& report) {
  Text out;
  for (const TerrainFileInfo& file : report.files) addFile(out, file);
  const scenario::Terrain& terrain = *report.terrain;
  out.add("\nArea: {}\n", boxText(report.needed));
  if (std::isnan(terrain.lowest_m())) {
    out.add("Ground: no height is known; {}\n", terrain.placeText());
  } else {
    out.add("Ground: {:.1f} to {:.1f} m above EGM96 mean sea level, posts {:.4g} m apart at the finest\n",
            terrain.lowest_m(), terrain.highest_m(), terrain.postSpacing_m());
  }
  out.add("Missing: {} void posts; {:.3g} % of the area has no file\n", terrain.voidPosts(),
          100 * terrain.uncoveredFraction());
  for (const std::string& warning : terrain.warnings()) out.add("Assumed: {}\n", warning);
  return out.take();
}

render::Image8 drawTerrain(const TerrainReport& report, const std::string& title, int width) {
  constexpr double kPixels = 600;  // of the longer side of the area
  constexpr double kMaxExtent_deg = 60;
  const GeoBox& box = report.needed;
  if (box.north_deg - box.south_deg > kMaxExtent_deg || box.east_deg - box.west_deg > 3 * kMaxExtent_deg)
    throw Error(ErrorCode::usage, fmt::format("a picture shows at most {} degrees of latitude and {} of longitude; the "
                                              "files cover {}: name fewer",
                                              kMaxExtent_deg, 3 * kMaxExtent_deg, boxText(box)));
  study::MapArea area;
  area.box = box;
  const double nearest_deg =
      box.south_deg > 0 ? box.south_deg : box.north_deg < 0 ? box.north_deg : 0;  // to the equator
  const double extent_m =
      kMetresPerDegree * std::max(box.north_deg - box.south_deg,
                                  (box.east_deg - box.west_deg) * std::cos(degToRad(nearest_deg)));
  const study::MapGrid grid = study::makeMapGrid(area, extent_m / kPixels, "local");
  study::MapPictureOptions options;
  options.width = width;
  options.title = title;
  const scenario::Terrain& terrain = *report.terrain;
  options.subtitle =
      std::isnan(terrain.lowest_m())
          ? std::string("no height is known")
          : fmt::format("{:.0f} to {:.0f} m above mean sea level; {} void posts; {:.3g} % without a file",
                        terrain.lowest_m(), terrain.highest_m(), terrain.voidPosts(),
                        100 * terrain.uncoveredFraction());
  options.ground_msl_m = study::groundOf(grid, terrain);
  return study::drawMap(grid, sourcesMap(report, grid), options);
}

}  // namespace emscape::report
