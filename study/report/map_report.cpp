#include "study/report/map_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/files/file_digest.h"
#include "base/files/json_writing.h"
#include "base/geodesy/fast_geodesy.h"
#include "base/text/quantity_text.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/snapshot.h"
#include "propagation/registry/model_info.h"
#include "scenario/file/save_scenario.h"

namespace emscape::study {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

bool isAboveGround(const MapHeight& height) {
  return height.reference == emfield::HeightReference::ground;
}

/// Whether a map's areas are listed by label: categories, and classes that say more than yes and no.
bool hasRowPerLabel(const Map& map) {
  return map.kind == MapKind::category || (map.kind == MapKind::classes && map.labels.size() > 2);
}

Json toJson(const MapRecord& record) {
  const Map& map = record.map;
  Json json{
      {"product", map.name}, {"files", record.files}, {"description", map.description}, {"unit", map.unit}};
  if (map.height) json[isAboveGround(*map.height) ? "height_agl_m" : "height_msl_m"] = map.height->metres;
  if (map.time_s) json["time_s"] = *map.time_s;
  json["min"] = number(record.summary.min);
  json["max"] = number(record.summary.max);
  json["known_area_km2"] = record.summary.known_area_m2 / 1e6;
  json["unknown_area_km2"] = record.summary.unknown_area_m2 / 1e6;
  if (map.area_class > 0 || map.unreached_area_m2) {
    json["area_km2"] = record.summary.class_area_m2 / 1e6;
    json["share_of_known"] = number(record.summary.class_area_m2 / record.summary.known_area_m2);
  }
  if (hasRowPerLabel(map)) {
    const std::vector<double>& areas_m2 = record.summary.label_areas_m2;
    for (std::size_t n = 0; n < areas_m2.size(); ++n) json["areas_km2"][map.labels[n]] = areas_m2[n] / 1e6;
  }
  return json;
}

std::vector<std::string> emitterNames(const scenario::Scenario& scenario) {
  std::vector<std::string> names;
  for (const scenario::Emitter& emitter : scenario.emitters) names.push_back(emitter.name);
  return names;
}

std::vector<std::string> editsOf(const scenario::Scenario& scenario) {
  std::vector<std::string> edits;
  for (const scenario::Edit& edit : scenario.edits()) edits.push_back(scenario::toString(edit));
  return edits;
}

/// The text with its edits, as a file of its own folder; empty where it was not read from a file.
std::string textOf(const scenario::Scenario& scenario) {
  if (!scenario.source) return "";
  return scenario::scenarioTextIn(scenario, std::filesystem::absolute(scenario.file).parent_path());
}

/// Elevation and land-cover files of all scenarios, each once.
std::set<std::string> terrainFilesOf(const MapStudy& study) {
  std::set<std::string> files;
  for (const auto& scenario : study.scenarios) {
    if (!scenario->terrain) continue;
    for (std::string& file : scenario->terrain->rasters()) files.insert(std::move(file));
  }
  return files;
}

/// A word of a command line.
std::string quoted(const std::string& word) {
  if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/") ==
      std::string::npos) {
    return word;
  }
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/// The closest active emitter of those for the quantity; -1: none.
int nearestEmitter(const MapStudy& study, const scenario::Snapshot& snapshot,
                   const emfield::Surface::Position& position) {
  const FastGeodesy from = fastGeodesy(position.latitude_deg, position.longitude_deg);
  int nearest = -1;
  double nearest_m = INFINITY;
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::EmitterState& state = snapshot.emitters[e];
    const bool is_radar = snapshot.scenario->emitters[e].kind == scenario::EmitterKind::radar;
    if (!state.active || (scenario::needsRadar(study.quantity) && !is_radar)) continue;
    const double distance_m =
        fastInverse(from, toEcef({state.position.latitude_deg, state.position.longitude_deg, 0})).distance_m;
    if (distance_m < nearest_m) {
      nearest = static_cast<int>(e);
      nearest_m = distance_m;
    }
  }
  return nearest;
}

/// The command that explains the pixel with the largest value of the first map of levels at a height and a
/// time, else of the first map; empty: there is no such map.
std::string explainCommand(const MapStudy& study, const std::vector<MapRecord>& records) {
  const MapRecord* shown = nullptr;
  for (const MapRecord& record : records) {
    if (!record.map.height || !record.map.time_s || record.summary.largest_pixel < 0) continue;
    if (shown == nullptr || (isWhole(shown->map.kind) && !isWhole(record.map.kind))) shown = &record;
  }
  if (shown == nullptr) return "";
  const Map& map = shown->map;
  const scenario::Scenario& scenario = *study.scenarios.front();
  const emfield::Surface::Position position = study.grid->positions[shown->summary.largest_pixel];
  const int emitter = nearestEmitter(
      study, scenario::snapshotAt(study.scenarios.front(), study.terrain.get(), *map.time_s), position);
  if (emitter < 0) return "";
  std::string command =
      fmt::format("emscape profile {} --emitter {} --time {} --to {:.7f},{:.7f},{}{}", quoted(scenario.file),
                  quoted(scenario.emitters[emitter].name), *map.time_s, position.latitude_deg,
                  position.longitude_deg, map.height->metres, isAboveGround(*map.height) ? " --agl" : "");
  for (const std::string& edit : editsOf(scenario)) command += " --set " + quoted(edit);
  return command + " --set output.radar_look=target";
}

}  // namespace

std::string reportJsonOf(const MapStudy& study, const std::vector<MapRecord>& records,
                         const std::vector<std::string>& files, const std::vector<std::string>& warnings,
                         const std::string& more) {
  const scenario::Scenario& scenario = *study.scenarios.front();
  const MapGrid& grid = *study.grid;
  Json report{{"emscape", EMSCAPE_VERSION},
              {"scenario", scenario.name},
              {"file", scenario.file},
              {"scenario_hash", scenario.hash},
              {"quantity", scenario::info(study.quantity).name},
              {"threshold", study.threshold},
              {"radar_look", "target"},
              {"crs", grid.crs},
              {"cell_m", grid.cell_m},
              {"pixels", {grid.width, grid.height}},
              {"area_weights", "ellipsoid"},
              {"clutter", emfield::clutterText(scenario)},
              {"emitters", emitterNames(scenario)}};
  if (!more.empty()) report.update(Json::parse(more));
  report["files"] = files;
  report["maps"] = Json::array();
  for (const MapRecord& record : records) report["maps"].push_back(toJson(record));
  report["warnings"] = warnings;
  return dumpJson(report, 2) + "\n";
}

Json digestJson(const std::string& name, const std::filesystem::path& file) {
  const FileDigest digest = digestOf(file);
  return {{"file", name}, {"bytes", digest.bytes}, {"crc32", fmt::format("{:08x}", digest.crc32)}};
}

Json terrainJsonOf(const MapStudy& study) {
  Json terrain = Json::array();
  for (const std::string& file : terrainFilesOf(study))
    terrain.push_back(digestJson(std::filesystem::path(file).filename().string(), file));
  return terrain;
}

std::string studyJsonOf(const MapStudy& study, const Json& terrain, const std::filesystem::path& folder,
                        const std::vector<std::string>& files) {
  Json json{{"emscape", EMSCAPE_VERSION}, {"command", study.command}};
  json["scenarios"] = Json::array();
  for (const auto& scenario : study.scenarios) {
    json["scenarios"].push_back({{"name", scenario->name},
                                 {"file", scenario->file},
                                 {"path", std::filesystem::absolute(scenario->file).lexically_normal()},
                                 {"hash", scenario->hash},
                                 {"edits", editsOf(*scenario)},
                                 {"text", textOf(*scenario)}});
  }
  json["terrain"] = terrain;
  json["quantity"] = scenario::info(study.quantity).name;
  json["threshold"] = study.threshold;
  json["times_s"] = study.times_s;
  json["crs"] = study.grid->crs;
  json["cell_m"] = study.grid->cell_m;
  json["models"] = Json::array();
  for (const scenario::Emitter& emitter : study.scenarios.front()->emitters) {
    const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
    json["models"].push_back({{"emitter", emitter.name},
                              {"model", model.name},
                              {"reference", model.reference},
                              {"accuracy", model.accuracy}});
  }
  json["outputs"] = Json::array();
  for (const std::string& file : files) json["outputs"].push_back(digestJson(file, folder / file));
  return dumpJson(json, 2) + "\n";
}

ReportTable tableOf(const std::vector<MapRecord>& records) {
  ReportTable table;
  table.columns = {"product", "height", "time (s)", "area (km²)", "share of the known (%)",
                   "min",     "max",    "unit"};
  const bool has_unknown = std::any_of(records.begin(), records.end(), [](const MapRecord& record) {
    return record.summary.unknown_area_m2 > 0;
  });
  if (has_unknown) table.columns.emplace_back("unknown (km²)");
  table.caption =
      "Areas are those of the ellipsoid; the share is of the pixels with a known answer. Min and max are "
      "over "
      "the pixels.";
  const bool has_burn_through = std::any_of(records.begin(), records.end(), [](const MapRecord& record) {
    return record.map.name == info(Product::burn_through).name;
  });
  if (has_burn_through)
    table.caption += " Burn-through: covered is the coverage, jammed what jamming takes away from it.";
  for (const MapRecord& record : records) {
    const Map& map = record.map;
    const MapSummary& summary = record.summary;
    const auto addRow = [&](const std::string& name, std::optional<double> area_m2, bool has_range) {
      const auto text = [&](double value) {
        if (!has_range) return std::string();
        return map.kind == MapKind::count && std::isfinite(value) ? fmt::format("{}", value)
                                                                  : figureText(value, map.unit);
      };
      const bool has_share = area_m2 && summary.known_area_m2 > 0;
      const double share = has_share ? 100 * *area_m2 / summary.known_area_m2 : 0;
      table.rows.push_back(
          {name, map.height ? describe(*map.height) : "", map.time_s ? fmt::format("{}", *map.time_s) : "all",
           area_m2 ? figureText(*area_m2 / 1e6, "km2") : "", has_share ? figureText(share, "percent") : "",
           text(summary.min), text(summary.max), render::unitText(map.unit)});
      if (has_unknown) table.rows.back().push_back(figureText(summary.unknown_area_m2 / 1e6, "km2"));
    };
    if (hasRowPerLabel(map)) {
      // Of categories those that occur; of classes all but the first, which is nothing.
      const bool is_category = map.kind == MapKind::category;
      for (std::size_t n = is_category ? 0 : 1; n < map.labels.size(); ++n)
        if (!is_category || summary.label_areas_m2[n] > 0)
          addRow(map.title + ": " + map.labels[n], summary.label_areas_m2[n], false);
      continue;
    }
    addRow(map.title,
           map.area_class >= 0 || map.unreached_area_m2 ? std::optional(summary.class_area_m2) : std::nullopt,
           map.kind != MapKind::classes);
  }
  return table;
}

void addModels(HtmlReport& report, const scenario::Scenario& scenario) {
  report.section("Models and their accuracy");
  ReportTable models{{"emitter", "model", "reference", "accuracy (test)"}, {}, ""};
  for (const scenario::Emitter& emitter : scenario.emitters) {
    const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
    models.rows.push_back({emitter.name, model.name, model.reference, model.accuracy});
  }
  report.table(models);
  report.paragraph(
      "The accuracy is that of the implementation against its reference. It does not say how far the model "
      "is "
      "from a measurement: that depends on the terrain, the weather and the model's assumptions.");
}

void addInputs(HtmlReport& report, const MapStudy& study, const std::vector<MapRecord>& records) {
  report.section("Inputs");
  std::vector<std::pair<std::string, std::string>> facts;
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    const scenario::Scenario& scenario = *study.scenarios[s];
    const std::string letter =
        study.scenarios.size() > 1 ? std::string(" ") + static_cast<char>('A' + s) : "";
    facts.emplace_back("scenario" + letter, fmt::format("{} ({})", scenario.name, scenario.file));
    facts.emplace_back("hash of the scenario" + letter, scenario.hash);
    for (const std::string& edit : editsOf(scenario)) facts.emplace_back("changed by --set" + letter, edit);
  }
  for (const std::string& file : terrainFilesOf(study)) {
    facts.emplace_back("terrain", std::filesystem::path(file).filename().string());
  }
  const MapGrid& grid = *study.grid;
  const scenario::QuantityInfo& quantity = scenario::info(study.quantity);
  facts.emplace_back("quantity", fmt::format("{} ({})", titleOf(study.quantity), quantity.name));
  if (!quantity.categorical) facts.emplace_back("threshold", quantityText(study.threshold, quantity.unit));
  facts.emplace_back("times", study.times_s.size() == 1
                                  ? fmt::format("{} s", study.times_s.front())
                                  : fmt::format("{}, from {} to {} s", study.times_s.size(),
                                                study.times_s.front(), study.times_s.back()));
  facts.emplace_back("epoch", study.scenarios.front()->clock.epoch_utc.empty()
                                  ? "none; files that need a date take 1970-01-01T00:00:00Z as time 0"
                                  : study.scenarios.front()->clock.epoch_utc);
  facts.emplace_back("radars", "look at the target, wherever their scan points");
  facts.emplace_back("projection", grid.crs);
  facts.emplace_back("pixels", fmt::format("{} × {} of {} m", grid.width, grid.height, grid.cell_m));
  facts.emplace_back("heights refer to", "mean sea level by EGM96 (EPSG:5773), or the ground");
  facts.emplace_back("emscape", EMSCAPE_VERSION);
  report.facts(facts);
  for (const auto& scenario : study.scenarios) {
    const std::string text = textOf(*scenario);
    if (!text.empty()) report.folded("The scenario '" + scenario->name + "' with its changes", text);
  }

  addModels(report, *study.scenarios.front());

  const std::string command = explainCommand(study, records);
  if (command.empty()) return;
  report.section("Why a pixel has its value");
  report.paragraph(
      "This command explains the path from the nearest emitter to the pixel with the largest value, term by "
      "term. Other coordinates explain other pixels.");
  report.facts({{"command", command}});
}

}  // namespace emscape::study
