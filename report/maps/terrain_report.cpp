#include "report/maps/terrain_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "report/json.h"
#include "report/text.h"
#include "study/picture/terrain_picture.h"

namespace emscape::report {
namespace {

using scenario::GeoBox;
using scenario::TerrainFileInfo;

Json boxJson(const GeoBox& box) {
  return {{"south_deg", box.south_deg},
          {"north_deg", box.north_deg},
          {"west_deg", box.west_deg},
          {"east_deg", box.east_deg}};
}

std::string boxText(const GeoBox& box) {
  return fmt::format("latitudes {:.5f} to {:.5f}, longitudes {:.5f} to {:.5f} deg", box.south_deg,
                     box.north_deg, box.west_deg, box.east_deg);
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
                     3600 * file.post_spacing_lat_deg, 3600 * file.post_spacing_lon_deg,
                     study::postSpacing_m(file));
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
}

/// Parts of the area (percent) by class; the classes that are not there are left out.
struct CoverParts {
  std::vector<std::pair<const scenario::CoverClass*, double>> classes;
  double unknown_percent = 100;

  explicit CoverParts(const scenario::LandCover& cover) {
    double all = static_cast<double>(cover.unknownCells());
    for (const long long count : cover.cellCounts()) all += static_cast<double>(count);
    if (!(all > 0)) return;
    unknown_percent = 100 * static_cast<double>(cover.unknownCells()) / all;
    for (std::size_t k = 0; k < cover.classes().size(); ++k) {
      if (cover.cellCounts()[k] > 0)
        classes.emplace_back(&cover.classes()[k], 100 * static_cast<double>(cover.cellCounts()[k]) / all);
    }
    std::stable_sort(classes.begin(), classes.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
  }
};

void addCover(Text& out, const scenario::LandCover& cover) {
  const CoverParts parts(cover);
  out.add("Land cover: cells of {:.3g} m; {:.1f} % of the area without a class\n", cover.cell_m(),
          parts.unknown_percent);
  for (const auto& [of, percent] : parts.classes) {
    const std::string use =
        of->zone == scenario::CoverZone::land
            ? fmt::format("clutter {:g} m{}{}", of->clutter_height_m, of->kind ? ", echo of " : "",
                          of->kind ? toString(*of->kind) : "")
            : std::string(of->zone == scenario::CoverZone::sea ? "sea" : "water, sea where it is low");
    out.add("  {:5.1f} %  {:3} {}: {}\n", percent, of->code, of->name, use);
  }
}

}  // namespace

Json landCoverJson(const scenario::LandCover& cover) {
  const CoverParts parts(cover);
  Json classes = Json::array();
  for (const auto& [of, percent] : parts.classes) {
    classes.push_back({{"code", of->code},
                       {"name", of->name},
                       {"percent", percent},
                       {"clutter_height_m", of->clutter_height_m},
                       {"zone", toString(of->zone)},
                       {"land", of->kind ? Json(toString(*of->kind)) : Json(nullptr)}});
  }
  return {{"cell_m", cover.cell_m()}, {"unknown_percent", parts.unknown_percent}, {"classes", classes}};
}

TerrainReport terrainReport(const scenario::TerrainSpec& spec) {
  TerrainReport report;
  report.files = scenario::Terrain::describeAll(spec, nullptr);
  report.needed = around(report.files);
  report.terrain = scenario::Terrain::load(spec, report.needed);
  return report;
}

TerrainReport terrainReport(const scenario::Scenario& scenario) {
  if (!scenario.terrain)
    throw Error(ErrorCode::bad_input, {scenario.file, 0, 0},
                "the scenario names no elevation files (terrain.files)");
  TerrainReport report;
  report.needed = scenario::terrainBox(scenario);
  report.files = scenario::Terrain::describeAll(*scenario.terrain, &report.needed);
  report.terrain =
      scenario::Terrain::load(*scenario.terrain, report.needed, scenario::neededPlaces(scenario));
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
                     {"spacing_m", study::postSpacing_m(file)},
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
  Json json{{"files", files},
            {"area", boxJson(report.needed)},
            {"lowest_msl_m", number(terrain.lowest_m())},
            {"highest_msl_m", number(terrain.highest_m())},
            {"post_spacing_m", number(terrain.postSpacing_m())},
            {"void_posts", terrain.voidPosts()},
            {"uncovered_percent", 100 * terrain.uncoveredFraction()},
            {"warnings", terrain.warnings()}};
  if (terrain.landCover() != nullptr) json["land_cover"] = landCoverJson(*terrain.landCover());
  return json;
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
  if (terrain.landCover() != nullptr) addCover(out, *terrain.landCover());
  for (const std::string& warning : terrain.warnings()) out.add("Assumed: {}\n", warning);
  return out.take();
}

}  // namespace emscape::report
