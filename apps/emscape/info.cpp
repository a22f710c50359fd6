/// emscape info: contents of a file.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <limits>
#include <memory>

#include "apps/emscape/command.h"
#include "apps/emscape/console.h"
#include "apps/emscape/waveform_report.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/playback/inputs.h"
#include "emscape/playback/volume_input.h"
#include "emscape/scenario/scenario_file.h"
#include "emscape/volume/file.h"
#include "emscape/volume/statistics.h"
#include "scenario/antenna/shapes.h"

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

Json describeScenario(const std::string& file) {
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
    if (emitter.waveform) emitters.back()["waveform"] = waveformJson(emitter);
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
  return {{"kind", "scenario"},
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
          {"platforms", platforms},
          {"emitters", emitters},
          {"receivers", receivers},
          {"targets", targets},
          {"channels", channels}};
}

Json describeVolume(const volume::DenseVolume& volume) {
  const volume::VolumeInfo& info = volume.info;
  const volume::Statistics statistics = volume::statisticsOf(volume);
  Json json{{"quantity", info.quantity},
            {"unit", info.unit},
            {"dims", toJson(volume.grid.dims)},
            {"spacing_m", toJson(volume.grid.spacing_m)},
            {"first_center_m", toJson(volume.grid.first_center_m)},
            {"frame", volume.grid.georeferenced ? toJson(volume.grid.frame) : Json(nullptr)},
            {"time_s", info.time_s},
            {"time_utc", info.time_utc},
            {"floor", info.floor},
            {"range", {info.range_min, info.range_max}},
            {"categorical", info.categorical},
            {"min", statistics.min},
            {"max", statistics.max},
            {"mean", statistics.mean},
            {"voxels", statistics.voxels},
            {"masked_voxels", statistics.masked},
            {"nan_voxels", statistics.nan}};
  Json extra = Json::object();
  for (const auto& [key, value] : info.extra) extra[key] = value;
  json["extra"] = extra;
  return json;
}

/// The first step's volumes; of a series also its steps.
Json describeVolumeFiles(const std::string& path) {
  std::string quantity;
  const std::vector<playback::VolumeFile> files = playback::volumeFilesOf(path, quantity);
  Json volumes = Json::array();
  for (const volume::DenseVolume& volume : volume::listVolume(files.front().file).volumes) {
    volumes.push_back(describeVolume(volume::readVolume(files.front().file, volume.info.quantity)));
  }
  Json json{{"kind", "volume"}, {"file", path}, {"steps", files.size()}};
  json["times_s"] = Json::array();
  for (const playback::VolumeFile& file : files) json["times_s"].push_back(file.time_s);
  json["volumes"] = volumes;
  return json;
}

Json describeElevation(const std::string& file) {
  const scenario::TerrainFileInfo info = scenario::Terrain::describe(file);
  return {{"kind", "elevation"},
          {"file", file},
          {"format", info.format},
          {"crs", info.crs},
          {"columns", info.columns},
          {"rows", info.rows},
          {"box", toJson(info.box)},
          {"post_spacing_lat_deg", info.post_spacing_lat_deg},
          {"post_spacing_lon_deg", info.post_spacing_lon_deg},
          {"lowest_m", info.lowest_m},
          {"highest_m", info.highest_m},
          {"void_posts", info.void_posts}};
}

Json describeAntenna(const std::string& file) {
  // A CSV grid contains only a shape: its gain is in the scenario.
  const bool has_gain = file.size() < 4 || file.substr(file.size() - 4) != ".csv";
  const scenario::AntennaPtr antenna =
      scenario::readAntenna(file, has_gain ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  return {{"kind", "antenna"},
          {"file", file},
          {"description", antenna->description},
          {"gain_dbi", has_gain ? Json(antenna->gain_dbi) : Json(nullptr)},
          {"beamwidth_az_deg", antenna->beamwidth_az_deg},
          {"beamwidth_el_deg", antenna->beamwidth_el_deg}};
}

/// A JSON report as indented lines of text: the same facts for people.
void printText(const Json& json, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [key, value] : json.items()) {
    const bool nested =
        value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
    if (!nested) {
      print("{}{}: {}\n", indent, key, value.is_string() ? value.get<std::string>() : value.dump());
    } else if (value.is_object()) {
      print("{}{}:\n", indent, key);
      printText(value, depth + 1);
    } else {
      for (const Json& item : value) {
        print("{}{}:\n", indent, key);
        printText(item, depth + 1);
      }
    }
  }
}

Json describe(const std::string& file) {
  switch (playback::inputKindOf(file)) {
    case playback::InputKind::scenario:
      return describeScenario(file);
    case playback::InputKind::volume:
      return describeVolumeFiles(file);
    case playback::InputKind::elevation:
      return describeElevation(file);
    case playback::InputKind::antenna:
      break;
  }
  return describeAntenna(file);
}

int info(const std::string& file, const GlobalOptions& global) {
  const Json report = describe(file);
  if (global.json) {
    printJson(report);
  } else {
    printText(report, 0);
  }
  return 0;
}

}  // namespace

void addInfo(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("info", "Describe a scenario, volume, elevation or antenna file");
  command->fallthrough();
  command->footer(R"(
Scenarios: .yaml .yml .json. Volumes: .vdb .nvdb .vti .raw .dat; series: .pvd or a folder (its first step is described).
Elevation: .tif .hgt .dt0 .dt1 .dt2 .vrt. Antennas: .msi .pln .csv.

Examples:
  emscape info scenarios/jacksboro.yaml
  emscape info out/jacksboro_0001.vdb --json)");
  auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "File, or folder of volumes")->required();
  command->callback([file, &global, &action] { action = [file, &global] { return info(*file, global); }; });
}

}  // namespace emscape::app
