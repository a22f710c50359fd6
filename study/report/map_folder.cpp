#include "study/report/map_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "base/files/own_file.h"
#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "base/text/quantity_text.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/error.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/snapshot.h"
#include "playback/frames/ground.h"
#include "render/picture/png_comment.h"
#include "study/files/czml.h"
#include "study/files/geojson.h"
#include "study/files/geopackage.h"
#include "study/files/geotiff.h"
#include "study/files/kmz.h"
#include "study/files/map_collection.h"
#include "study/files/map_metadata.h"
#include "study/files/netcdf.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_marks.h"
#include "study/picture/map_picture.h"
#include "study/report/coverage_summary.h"
#include "study/report/earlier_outputs.h"
#include "study/report/map_report.h"

namespace emscape::study {
namespace {

/// Pictures in report.html; each takes several hundred kilobytes.
constexpr std::size_t kMaxPictures = 24;

struct Format {
  MapFormat info;
  MakeCollection make;  ///< null: a file of each map
};
const std::vector<Format>& formatTable() {
  static const std::vector<Format> kTable{
      {{"cog", "cloud-optimised GeoTIFF of each map: GIS programs, GDAL"}, nullptr},
      {{"png", "picture of each map over the shaded ground, with legend and axes"}, nullptr},
      {{"gpkg",
        "GeoPackage of all maps as bands and contours, with emitters and tracks: QGIS, with its colours"},
       makeGeoPackage},
      {{"geojson", "GeoJSON of all maps as bands, with emitters, sites and tracks: web maps, GIS programs"},
       makeGeoJson},
      {{"nc", "netCDF (CF-1.8) of all maps over time and height: xarray, Panoply, QGIS"}, makeNetCdf},
      {{"kmz", "overlays of all maps over time, with emitters and tracks: Google Earth"}, makeKmz},
      {{"czml",
        "outlines of classes (covered, jam_loss, burn_through) over time, with emitters and tracks: Cesium"},
       makeCzml},
  };
  return kTable;
}

/// Creates an output folder, with its parents, and its inner folder. On destruction, created folders that are
/// empty are removed: after an error before the first file.
class MadeFolder {
 public:
  MadeFolder(const std::filesystem::path& folder, const std::filesystem::path& inner) {
    std::error_code failed;
    for (std::filesystem::path at = folder / inner; !at.empty() && !std::filesystem::exists(at, failed);
         at = at.parent_path()) {
      made_.push_back(at);
    }
    makeFolderIn(folder, inner);
  }
  ~MadeFolder() {
    std::error_code is_not_empty;
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, is_not_empty);
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  // the innermost first
};

}  // namespace

const std::vector<MapFormat>& mapFormats() {
  static const std::vector<MapFormat> kFormats = [] {
    std::vector<MapFormat> formats;
    for (const Format& format : formatTable()) formats.push_back(format.info);
    return formats;
  }();
  return kFormats;
}

struct MapFolder::State {
  struct Collection {
    std::string file;  ///< relative to the folder
    std::unique_ptr<MapCollection> content;
  };
  struct Picture {
    std::string caption;
    render::Image8 image;
  };

  std::filesystem::path folder;
  MadeFolder maps_folder;
  FolderLock lock;
  const nlohmann::ordered_json earlier_outputs;
  MapStudy study;
  const nlohmann::ordered_json terrain;  ///< its files, as they are before the maps
  bool has_cog = false, has_png = false;
  MapPictureOptions background;  ///< of all pictures: what is below the colours
  std::optional<MapMarks> marks;
  std::vector<Collection> collections;
  std::vector<MapRecord> records;
  std::vector<Picture> pictures;
  std::string report_json;

  State(const std::filesystem::path& path, MapStudy of)
      : folder(path),
        maps_folder(path, "maps"),
        lock(path, ".maps.lock"),
        earlier_outputs(outputsOf(path, of.command)),
        study(std::move(of)),
        terrain(terrainJsonOf(study)) {
    for (const std::filesystem::path& written : {path, path / "maps"}) removeAbandonedFiles(written);
    marks.emplace(study);
    setBackground();
  }

  /// Ground, or water and shores, of all pictures.
  void setBackground() {
    const MapGrid& grid = *study.grid;
    const bool has_drape = !study.view.drape.empty();  // with finer squares
    const int parts = background.refinement = refinementOf(grid, (has_drape ? 2 : 1) * background.width);
    std::optional<MapGrid> finer;
    if (parts > 1) {
      finer = mapGridAt(grid.wkt, grid.crs, grid.cell_m / parts, grid.left_m, grid.top_m, grid.width * parts,
                        grid.height * parts);
    }
    const MapGrid& squares = finer ? *finer : grid;
    if (has_drape) background.drape = drapeOf(squares, study.view.drape, study.terrain.get());
    if (study.view.drape == scenario::kLandCoverDrape && study.terrain &&
        study.terrain->landCover() != nullptr) {
      std::vector<GeodeticPosition> positions;
      for (const auto& [latitude_deg, longitude_deg] : grid.positions) {
        if (!std::isnan(latitude_deg)) positions.push_back({latitude_deg, longitude_deg, 0});
      }
      background.ground_classes = playback::groundClassesOf(*study.terrain->landCover(), positions);
    }
    if (study.terrain != nullptr) {
      background.ground_msl_m = groundOf(squares, *study.terrain);
    } else {
      addCoast(grid, squares, background);
    }
  }

  void addFormat(const std::string& name) {
    const auto& table = formatTable();
    const auto format =
        std::find_if(table.begin(), table.end(), [&](const Format& row) { return name == row.info.name; });
    if (format == table.end()) {
      std::string known;
      for (const Format& row : table) known += (known.empty() ? "" : ", ") + std::string(row.info.name);
      throw Error(ErrorCode::usage, fmt::format("unknown format '{}'; one of {}", name, known));
    }
    has_cog = has_cog || name == "cog";
    has_png = has_png || name == "png";
    if (format->make == nullptr) return;
    const std::string file = fmt::format("maps/{}.{}", study.command, name);
    const bool is_there = std::any_of(collections.begin(), collections.end(),
                                      [&](const Collection& other) { return other.file == file; });
    if (is_there) return;
    collections.push_back({file, format->make(folder / file, study)});
  }

  /// In seconds, and in UTC if the scenario has an epoch.
  std::string timesText(const Map& map) const {
    const double begin_s = map.time_s.value_or(study.times_s.front());
    const double end_s = map.time_s.value_or(study.times_s.back());
    const auto from = [&](const auto& begin, const auto& end) {
      return begin_s == end_s ? fmt::format("{}", begin) : fmt::format("{} to {}", begin, end);
    };
    const auto utc = [&](double time_s) { return scenario::utcAt(study.scenarios.front()->clock, time_s); };
    const std::string seconds = fmt::format("t = {} s", from(begin_s, end_s));
    return utc(begin_s).empty() ? seconds : seconds + " (" + from(utc(begin_s), utc(end_s)) + ")";
  }

  render::Image8 pictureOf(const Map& map) const {
    const double time_s = map.time_s.value_or(study.times_s.front());
    MapPictureOptions options = background;
    options.title =
        fmt::format("{}: {}", titleOfScenarios(), render::displayText(descriptionOf(map, study.view.units)));
    options.subtitle = timesText(map);
    const scenario::Snapshot snapshot =
        scenario::snapshotAt(study.scenarios.front(), study.terrain.get(), time_s);
    options.markers = markersOf(snapshot);
    marks->addTo(options, snapshot);
    return drawMap(*study.grid, map, options);
  }

  /// The edits of all scenarios, for the files of pictures.
  std::string changes() const {
    std::string all;
    for (const auto& scenario : study.scenarios) {
      const std::string changes = changesOf(*scenario);
      all += (all.empty() || changes.empty() ? "" : "\n") + changes;
    }
    return all;
  }

  std::string titleOfScenarios() const {
    std::string title = scenario::titleOf(*study.scenarios.front());
    if (study.scenarios.size() > 1) title += " and " + scenario::titleOf(*study.scenarios.back());
    return title;
  }

  /// The scenarios of a comparison, and what differs from their files.
  void addCompared(HtmlReport& report) const {
    report.section("What is compared");
    std::vector<std::pair<std::string, std::string>> facts;
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
      const scenario::Scenario& scenario = *study.scenarios[s];
      const std::string letter(1, static_cast<char>('A' + s));
      facts.emplace_back(letter, fmt::format("{} ({})", scenario.name, scenario.file));
      for (const scenario::Edit& edit : scenario.edits())
        facts.emplace_back(letter + ", changed", scenario::toString(edit));
    }
    report.facts(facts);
  }

  std::string htmlOf(const std::vector<std::string>& files, const std::vector<std::string>& warnings,
                     const AddSections& addSections) const {
    const MapGrid& grid = *study.grid;
    const scenario::QuantityInfo& quantity = scenario::info(study.quantity);
    const std::string threshold =
        quantity.categorical ? ""
                             : render::displayText(" >= " + quantityText(study.threshold, quantity.unit));
    HtmlReport report(study.title, fmt::format("{} × {} pixels of {} m in {}; {}{}", grid.width, grid.height,
                                               grid.cell_m, grid.crs, titleOf(study.quantity), threshold));
    if (study.scenarios.size() == 1) {
      for (const std::string& sentence : coverageSummary(study, records)) report.summary(sentence);
    }
    report.summary("ground cover: " + emfield::clutterText(*study.scenarios.front()));
    if (const std::string target = emfield::targetText(*study.scenarios.front()); !target.empty())
      report.summary("target: " + target);
    report.warnings(warnings);
    if (study.scenarios.size() == 1) {
      report.section("Areas and ranges");
      report.table(tableOf(records));
    } else {
      addCompared(report);
    }
    if (addSections) addSections(report);
    report.section("Maps");
    for (const Picture& picture : pictures) report.picture(picture.image, picture.caption);
    if (records.size() > pictures.size()) {
      report.paragraph(fmt::format("The first {} of {} maps are shown.", pictures.size(), records.size()));
    }
    addInputs(report, study, records);
    report.section("Files");
    ReportTable table{{"file"}, {}, "Relative to this report's folder."};
    for (const std::string& file : files) table.rows.push_back({file});
    report.table(table);
    return report.html();
  }
};

MapFolder::MapFolder(const std::filesystem::path& folder, MapStudy study,
                     const std::vector<std::string>& formats)
    : state_(std::make_unique<State>(folder, std::move(study))) {
  for (const std::string& format : formats) state_->addFormat(format);
}

MapFolder::~MapFolder() = default;

void MapFolder::requireReplaceable(const std::vector<std::string>& names) const {
  std::vector<std::string> files;
  for (const std::string& name : names) {
    if (state_->has_png) requireOwn(state_->folder / "maps" / (name + ".png"));
    if (state_->has_cog) files.push_back("maps/" + name + ".tif");
  }
  for (const State::Collection& collection : state_->collections) files.push_back(collection.file);
  for (const std::string& file : files) {
    requireOwn(state_->folder / file);
    requireOwnBeside(state_->folder / file);
  }
}

const MapRecord& MapFolder::add(const Map& map) {
  State& state = *state_;
  MapRecord record;
  record.summary = summaryOf(*state.study.grid, map);
  const std::string name = "maps/" + fileNameOf(map);
  if (state.has_cog) {
    record.files.push_back(name + ".tif");
    writeGeoTiff(state.folder / record.files.back(), *state.study.grid, map, metadataOf(state.study, map));
  }
  const bool is_in_report = state.pictures.size() < kMaxPictures;
  if (state.has_png || is_in_report) {
    render::Image8 picture = state.pictureOf(map);
    if (state.has_png) {
      record.files.push_back(name + ".png");
      const std::string png = render::withPngComment(render::encodePng(picture), state.changes());
      writeWhole(state.folder / record.files.back(), [&](std::ostream& out) { out << png; });
    }
    if (is_in_report) {
      state.pictures.push_back(
          {render::displayText(map.description) + ", " + state.timesText(map), std::move(picture)});
    }
  }
  for (const State::Collection& collection : state.collections) collection.content->add(map);
  record.map = map;
  record.map.values = {};
  state.records.push_back(std::move(record));
  return state.records.back();
}

void MapFolder::finish(const std::vector<std::string>& warnings, const std::string& more,
                       const AddSections& addSections) {
  State& state = *state_;
  std::vector<std::string> files, for_all;
  for (const MapRecord& record : state.records) {
    for (const std::string& file : record.files) {
      files.push_back(file);
      const std::string labels = file + kAuxiliary;
      if (std::filesystem::exists(state.folder / labels)) files.push_back(labels);
    }
  }
  for (const State::Collection& collection : state.collections) {
    collection.content->finish();
    files.push_back(collection.file);
    for_all.push_back(collection.file);
  }
  const std::string html = state.htmlOf(files, warnings, addSections);
  state.report_json = reportJsonOf(state.study, state.records, for_all, warnings, more);
  const std::string inputs = studyJsonOf(state.study, state.terrain, state.folder, files);
  writeWhole({{state.folder / "study.json", [&](std::ostream& out) { out << inputs; }},
              {state.folder / "report.json", [&](std::ostream& out) { out << state.report_json; }},
              {state.folder / "report.html", [&](std::ostream& out) { out << html; }}});
  removeEarlierMaps(state.folder, state.earlier_outputs, {files.begin(), files.end()});
}

const std::vector<MapRecord>& MapFolder::records() const {
  return state_->records;
}

std::vector<std::string> MapFolder::collections() const {
  std::vector<std::string> files;
  for (const State::Collection& collection : state_->collections) files.push_back(collection.file);
  return files;
}

const std::string& MapFolder::reportJson() const {
  return state_->report_json;
}

}  // namespace emscape::study
