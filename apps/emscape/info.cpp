/// emscape info: contents of a file.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "base/files/inputs.h"
#include "base/files/json_writing.h"
#include "emfield/excess/model_choices.h"
#include "emscape/base/log.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/format/file.h"
#include "emscape/volume/statistics.h"
#include "playback/frames/volume_input.h"
#include "propagation/registry/model_info.h"
#include "render/annotate/plot.h"
#include "report/maps/output_files.h"
#include "report/paths/antenna_report.h"
#include "report/paths/choices_report.h"
#include "report/paths/refractivity_report.h"
#include "report/paths/waveform_report.h"
#include "report/runs/work_report.h"
#include "scenario/air/refractivity_file.h"
#include "volume/mesh/mesh_file.h"

namespace emscape::app {
namespace {

Json toJson(const Vec3d& v) {
  return {v.x, v.y, v.z};
}
Json toJson(const Dims& dims) {
  return {dims.x, dims.y, dims.z};
}

Json toJson(const scenario::GeoBox& box) {
  return {{"south_deg", box.south_deg},
          {"north_deg", box.north_deg},
          {"west_deg", box.west_deg},
          {"east_deg", box.east_deg}};
}

Json toJson(const FrameOrigin& frame) {
  return {{"kind", toString(frame.kind)},
          {"latitude_deg", frame.latitude_deg},
          {"longitude_deg", frame.longitude_deg},
          {"height_msl_m", frame.height_msl_m}};
}

/// Automatic choices of the emitters' models at the first step; reads the terrain only if there are any.
Json choicesOf(const std::shared_ptr<const scenario::Scenario>& scenario) {
  const bool has_any =
      std::any_of(scenario->emitters.begin(), scenario->emitters.end(), [](const scenario::Emitter& emitter) {
        return propagation::modelInfo(emitter.propagation.model).choices != nullptr;
      });
  if (!has_any) return Json::array();
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const double time_s = scenario::timesOf(scenario->clock).front();
  return report::choicesJson(
      emfield::modelChoices(scenario::snapshotAt(scenario, terrain.get(), time_s), terrain.get()));
}

/// Adds the warnings, and memory, time and disk space of the field; null if it cannot be computed (`validate`
/// reports the reason).
void addWork(const std::shared_ptr<const scenario::Scenario>& scenario, Json& json) {
  emfield::FieldOptions options;
  options.allow_missing_terrain = true;
  try {
    const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
    const emfield::FieldSolver solver(scenario, terrain, options);
    const scenario::Snapshot first =
        scenario::snapshotAt(scenario, terrain.get(), scenario::timesOf(scenario->clock).front());
    json["work"] = report::workJson(report::workEstimateOf(solver, *scenario, terrain.get(),
                                                           emfield::modelChoices(first, terrain.get())));
    std::vector<std::string> warnings = warningsOf(*scenario);
    for (const std::string& warning : solver.warnings()) warnings.push_back(warning);
    json["warnings"] = warnings;
  } catch (const Error&) {
    json["work"] = nullptr;
    json["warnings"] = warningsOf(*scenario);
  }
}

/// The contents of a file.
struct Description {
  Json json;
  std::shared_ptr<const propagation::Refractivity> refractivity;  ///< for the plot; null: there is none
  std::shared_ptr<const report::AntennaReport> antenna;           ///< the same
};

/// Frequencies of a scenario's emitters, ascending, each once.
std::vector<double> frequenciesOf(const scenario::Scenario& scenario) {
  std::set<double> frequencies_hz;
  for (const scenario::Emitter& emitter : scenario.emitters) frequencies_hz.insert(emitter.frequency_hz);
  return {frequencies_hz.begin(), frequencies_hz.end()};
}

Description describeScenario(const std::string& file) {
  const auto scenario = scenario::loadScenario(file);
  const scenario::Region& region = scenario->region;
  Json emitters = Json::array();
  for (const scenario::Emitter& emitter : scenario->emitters) {
    emitters.push_back({{"name", emitter.name},
                        {"kind", scenario::toString(emitter.kind)},
                        {"platform", scenario->platforms[static_cast<std::size_t>(emitter.platform)].name},
                        {"frequency_hz", emitter.frequency_hz},
                        {"power_w", emitter.power_w},
                        {"antenna", emitter.antenna->description},
                        {"gain_dbi", emitter.antenna->gain_dbi},
                        {"propagation", toString(emitter.propagation.model)}});
    if (emitter.waveform) emitters.back()["waveform"] = report::waveformJson(*scenario, emitter);
  }
  Json platforms = Json::array();
  for (const scenario::Platform& platform : scenario->platforms) {
    platforms.push_back({{"name", platform.name}, {"track_points", platform.track.size()}});
  }
  Json receivers = Json::array(), targets = Json::array();
  for (const scenario::ReceiverProfile& receiver : scenario->receivers) {
    receivers.push_back({{"name", receiver.name}, {"platform", nullptr}, {"gain_dbi", receiver.gain_dbi}});
  }
  for (const scenario::PlacedReceiver& receiver : scenario->placed_receivers) {
    receivers.push_back({{"name", receiver.name},
                         {"platform", scenario->platforms[static_cast<std::size_t>(receiver.platform)].name},
                         {"antenna", receiver.antenna->description},
                         {"gain_dbi", receiver.antenna->gain_dbi},
                         {"noise_figure_db", receiver.noise_figure_db.value_or(0)},
                         {"bandwidth_hz", receiver.bandwidth_hz}});
  }
  for (const scenario::Target& target : scenario->targets) {
    targets.push_back({{"name", target.name},
                       {"platform", scenario->platforms[static_cast<std::size_t>(target.platform)].name},
                       {"rcs_m2", target.table ? Json("by aspect") : Json(target.rcs_m2)},
                       {"swerling", target.swerling}});
  }
  Json channels = Json::array();
  for (const emfield::Channel& channel : emfield::channelsOf(*scenario, {})) channels.push_back(channel.name);
  Json json{
      {"kind", "scenario"},
      {"file", file},
      {"name", scenario->name},
      {"hash", scenario->hash},
      {"epoch_utc", scenario->clock.epoch_utc},
      {"duration_s", scenario->clock.duration_s},
      {"step_s", scenario->clock.step_s},
      {"frame", toJson(region.origin)},
      {"size_m", toJson(region.size_m)},
      {"dims", toJson(region.dims)},
      {"terrain_files", scenario->terrain ? Json(scenario->terrain->files) : Json::array()},
      {"land_cover_files", scenario->terrain ? Json(scenario->terrain->land_cover.files) : Json::array()},
      {"platforms", platforms},
      {"emitters", emitters},
      {"receivers", receivers},
      {"targets", targets},
      {"channels", channels},
      {"choices", choicesOf(scenario)}};
  addWork(scenario, json);
  const auto& refractivity = scenario->atmosphere.refractivity;
  if (refractivity) json["refractivity"] = report::refractivityJson(*refractivity, frequenciesOf(*scenario));
  return {json, refractivity, nullptr};
}

/// @param file  a CSV file of profiles, or soundings
Description describeRefractivity(const std::string& file) {
  constexpr double kGHz = 1e9;
  const scenario::RefractivityFile read =
      scenario::isSoundingFile(file) ? scenario::readSounding(file, {}) : scenario::readRefractivity(file);
  for (const std::string& warning : read.warnings) logWarning(warning);
  auto refractivity = std::make_shared<propagation::Refractivity>();
  refractivity->air = read.field;
  return {{{"kind", "refractivity"},
           {"file", file},
           {"holds", read.description},
           {"profiles", report::profilesJson(read.field, {1 * kGHz, 3 * kGHz, 10 * kGHz})}},
          refractivity,
          nullptr};
}

/// Appends the entries that volumes and fields on meshes share.
void addValues(Json& json, const volume::VolumeInfo& info, const volume::Statistics& statistics) {
  json["time_s"] = info.time_s;
  json["time_utc"] = info.time_utc;
  json["floor"] = info.floor;
  json["range"] = {info.range_min, info.range_max};
  json["categorical"] = info.categorical;
  json["min"] = statistics.min;
  json["max"] = statistics.max;
  json["mean"] = statistics.mean;
}

/// What places the values on the earth, as in the files.
void addPlace(Json& json, bool georeferenced, const FrameOrigin& frame) {
  if (!georeferenced) return;
  for (const auto& [key, text] : volume::standardWords(georeferenced, frame)) json[key] = text;
}

Json extraOf(const volume::VolumeInfo& info) {
  Json extra = Json::object();
  for (const auto& [key, value] : info.extra) extra[key] = value;
  return extra;
}

Json describeVolume(const volume::DenseVolume& volume) {
  const volume::Statistics statistics = volume::statisticsOf(volume);
  Json json{{"quantity", volume.info.quantity},
            {"unit", volume.info.unit},
            {"dims", toJson(volume.grid.dims)},
            {"spacing_m", toJson(volume.grid.spacing_m)},
            {"first_center_m", toJson(volume.grid.first_center_m)},
            {"frame", volume.grid.georeferenced ? toJson(volume.grid.frame) : Json(nullptr)}};
  addPlace(json, volume.grid.georeferenced, volume.grid.frame);
  addValues(json, volume.info, statistics);
  json["voxels"] = statistics.voxels;
  json["masked_voxels"] = statistics.masked;
  json["nan_voxels"] = statistics.nan;
  json["extra"] = extraOf(volume.info);
  return json;
}

/// Describes the volumes of the first step and, for a series, its steps.
Json describeVolumeFiles(const std::string& path) {
  std::string quantity;
  const std::vector<playback::VolumeFile> files = playback::volumeFilesOf(path, quantity);
  Json volumes = Json::array();
  for (const volume::DenseVolume& volume : volume::listVolume(files.front().file).volumes) {
    volume::DenseVolume read = volume::readVolume(files.front().file, volume.info.quantity);
    if (!read.info.has_time) read.info.time_s = files.front().time_s;
    volumes.push_back(describeVolume(read));
  }
  Json json{{"kind", "volume"}, {"file", path}, {"steps", files.size()}};
  json["times_s"] = Json::array();
  for (const playback::VolumeFile& file : files) json["times_s"].push_back(file.time_s);
  json["volumes"] = volumes;
  return json;
}

/// Describes the mesh and fields of the first step and, for a series, its steps.
Json describeMeshFiles(const std::string& path) {
  std::string quantity;
  const std::vector<playback::VolumeFile> files = playback::meshFilesOf(path, quantity);
  volume::MeshFile file = volume::readMesh(files.front().file);
  const volume::MeshBounds bounds = volume::boundsOf(*file.mesh);
  Json json{{"kind", "mesh"},
            {"file", path},
            {"steps", files.size()},
            {"times_s", Json::array()},
            {"points", file.mesh->points_m.size()},
            {"tetrahedra", file.mesh->cells.size()},
            {"inverted_tetrahedra", file.inverted_cells},
            {"boundary_faces", file.faces->boundary.size()},
            {"touching_faces", file.touching_faces},
            {"lower_m", toJson(bounds.lower_m)},
            {"upper_m", toJson(bounds.upper_m)},
            {"frame", file.mesh->georeferenced ? toJson(file.mesh->frame) : Json(nullptr)}};
  addPlace(json, file.mesh->georeferenced, file.mesh->frame);
  for (const playback::VolumeFile& step : files) json["times_s"].push_back(step.time_s);
  for (volume::MeshField& field : file.fields) {
    if (!field.info.has_time) field.info.time_s = files.front().time_s;
    const volume::Statistics statistics = volume::statisticsOf(field);
    Json described{{"quantity", field.info.quantity}, {"unit", field.info.unit}};
    addValues(described, field.info, statistics);
    described["points_without_field"] = statistics.nan;
    described["extra"] = extraOf(field.info);
    json["fields"].push_back(described);
  }
  return json;
}

/// Rounds to 12 digits, the accuracy of a width divided by a number of posts.
double twelveDigits(double value) {
  return std::stod(fmt::format("{:.12g}", value));
}

Json describeElevation(const std::string& file) {
  scenario::TerrainFileInfo info = scenario::Terrain::describe(file);
  info.notes.insert(info.notes.end(), info.warnings.begin(), info.warnings.end());
  return {{"kind", "elevation"},
          {"file", file},
          {"format", info.format},
          {"crs", info.crs},
          {"columns", info.columns},
          {"rows", info.rows},
          {"box", toJson(info.box)},
          {"vertical_datum", info.vertical_datum},
          {"height_unit", info.height_unit},
          {"post_spacing_lat_deg", twelveDigits(info.post_spacing_lat_deg)},
          {"post_spacing_lon_deg", twelveDigits(info.post_spacing_lon_deg)},
          {"lowest_m", info.lowest_m},
          {"highest_m", info.highest_m},
          {"void_posts", info.void_posts},
          {"notes", info.notes}};
}

/// A text unchanged if it fits on a line, otherwise quoted.
std::string onOneLine(const std::string& text) {
  const bool fits =
      std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  return fits ? text : dumpJson(Json(text));
}

/// Prints a JSON report as indented lines of text. Members of a list begin with "-".
void printText(const Json& json, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [key, value] : json.items()) {
    const bool nested =
        value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
    if (!nested) {
      print("{}{}: {}\n", indent, key,
            value.is_string() ? onOneLine(value.get<std::string>()) : dumpJson(value));
    } else if (value.is_object()) {
      print("{}{}:\n", indent, key);
      printText(value, depth + 1);
    } else {
      print("{}{}:\n", indent, key);
      for (const Json& item : value) {
        print("{}  -\n", indent);
        printText(item, depth + 2);
      }
    }
  }
}

/// The file of values for a header such as field.raw.json; other names unchanged.
std::string valuesFileOf(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string inner = path.stem().extension().string();
  const bool is_header =
      path.extension() == ".json" && (inner == ".raw" || inner == ".dat" || inner == ".nvdb");
  return is_header ? (path.parent_path() / path.stem()).string() : file;
}

Description describe(const std::string& name) {
  const std::string file = valuesFileOf(name);
  // The readers of some kinds would wait for the other end of a pipe.
  if (inputExists(file) && !std::filesystem::is_directory(file) && !std::filesystem::is_regular_file(file))
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "cannot read: it is not a regular file");
  if (scenario::isSoundingFile(file) || scenario::isRefractivityCsv(file)) return describeRefractivity(file);
  switch (playback::inputKindOf(file)) {
    case playback::InputKind::scenario:
      return describeScenario(file);
    case playback::InputKind::volume:
      return {describeVolumeFiles(file), nullptr, nullptr};
    case playback::InputKind::mesh:
      return {describeMeshFiles(file), nullptr, nullptr};
    case playback::InputKind::elevation:
      return {describeElevation(file), nullptr, nullptr};
    case playback::InputKind::recording:
      throw Error(ErrorCode::usage, file +
                                        " is a recording: `emscape import` makes a scenario of it and tells "
                                        "what is in it");
    case playback::InputKind::antenna:
      break;
  }
  if (scenario::isTableOfAir(file))
    throw Error(ErrorCode::bad_input, {file, 1, 1},
                fmt::format("a table of the air has other columns: {}; temperatures in kelvin, heights in "
                            "metres, humidity in percent",
                            scenario::refractivityColumns()));
  auto antenna = std::make_shared<report::AntennaReport>(report::readAntennaReport(file));
  for (const std::string& warning : antenna->warnings) logWarning(warning);
  return {report::antennaJson(*antenna), nullptr, antenna};
}

struct InfoOptions {
  std::string file;
  std::string plot;
  std::string size = "1400x800";
};

int info(const InfoOptions& options, const GlobalOptions& global) {
  report::checkOutputs({{"--plot", options.plot}}, {{"the input", options.file}}, {});
  const Description description = [&] {
    const EndAtInterrupts at_once;
    return describe(options.file);
  }();
  if (!options.plot.empty()) {
    const render::ImageSize size = render::parseImageSize(options.size);
    if (description.antenna) {
      report::plotAntenna(*description.antenna, size, options.plot);
    } else if (description.refractivity) {
      report::plotRefractivity(*description.refractivity,
                               std::filesystem::path(options.file).filename().string(), size, options.plot);
    } else {
      throw Error(ErrorCode::usage,
                  "--plot draws refractivity and antennas; " + options.file + " has neither");
    }
    logInfo("wrote " + options.plot);
  }
  if (global.json) {
    printJson(description.json);
  } else {
    printText(description.json, 0);
  }
  return 0;
}

}  // namespace

void addInfo(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "info", "Describe a scenario, volume, mesh, elevation, antenna or refractivity file");
  command->fallthrough();
  command->footer(R"(
Scenarios: .yaml .yml .json. Volumes: .vdb .nvdb .vti .raw .dat; fields on tetrahedra: .vtu; series:
.pvd or a folder (its first step is described).
Elevation: .tif .hgt .dt0 .dt1 .dt2 .vrt .asc .bil .flt .dem .img .nc .xyz .gpkg, also in .zip and .gz; `terrain` describes several
files and folders. Antennas: .msi .pln .adf .ant .pattern .az .el .csv.
Refractivity: .csv with a column height_msl_m; soundings of IGRA 2, the University of Wyoming and the Storm Prediction Center (any ending; the last is described). Each duct is given with
its heights, its strength, the largest trapped angle, the number of modes at 1, 3 and 10 GHz (of a scenario, at the frequencies of
its emitters), and the frequency from which it traps.

Examples:
  emscape info scenarios/jacksboro.yaml
  emscape info out/jacksboro_0001.vdb --json
  emscape info air.csv --plot air.png
  emscape info sector.adf --plot sector.svg)");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("FILE", options->file, "File, or folder of volumes")->required();
  command
      ->add_option(
          "--plot", options->plot,
          "Draw M and N against height, of refractivity and of scenarios that have it, into a .png or "
          ".svg")
      ->check([](const std::string& file) {
        return render::isPlotFile(file) ? "" : "'" + file + "': plots are written as .png or .svg";
      });
  command->add_option("--size", options->size, "Size of the plot in pixels, WxH");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return info(*options, global); }; });
}

}  // namespace emscape::app
