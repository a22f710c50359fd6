#include "interop/exporting/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "document/text_edit.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "interop/exporting/writers.h"
#include "interop/importing/nodes.h"
#include "recording/common/dates.h"
#include "scenario/file/source.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

/// Adds times so that none is more than step_s after the one before.
std::vector<double> filled(std::vector<double> times, double step_s) {
  std::sort(times.begin(), times.end());
  std::vector<double> result;
  for (const double time_s : times) {
    if (!result.empty() && time_s <= result.back()) continue;
    if (!result.empty()) {
      const double begin_s = result.back();
      const double gap_s = time_s - begin_s;
      const auto parts = static_cast<long long>(std::ceil(gap_s / step_s - 1e-9));
      for (long long i = 1; i < parts; ++i)
        result.push_back(begin_s + gap_s * static_cast<double>(i) / static_cast<double>(parts));
    }
    result.push_back(time_s);
  }
  return result;
}

double distance_m(const PoseSample& a, const PoseSample& b) {
  return geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg).distance_m;
}

}  // namespace

void requireFewRecords(const scenario::Scenario& scenario, double step_s) {
  constexpr double kMaxRecords = 2e7, kShortestHeartbeat_s = 2;
  const double records = scenario.clock.duration_s / std::min(step_s, kShortestHeartbeat_s) *
                         static_cast<double>(scenario.platforms.size() + scenario.emitters.size());
  if (records <= kMaxRecords) return;
  throw Error(ErrorCode::usage,
              fmt::format("about {:.2g} records, more than the allowed {:.2g}; give a larger --step, or a "
                          "part of the scenario: --set duration_s=3600",
                          records, kMaxRecords));
}

Presence presenceOf(const scenario::Scenario& scenario, const scenario::Platform& platform) {
  Presence presence{0, scenario.clock.duration_s};
  if (platform.moves() && platform.outside_track == scenario::OutsideTrack::absent) {
    presence.begin_s = std::max(presence.begin_s, platform.track.front().t_s);
    presence.end_s = std::min(presence.end_s, platform.track.back().t_s);
  }
  return presence;
}

std::vector<double> timesOfPositions(const scenario::Scenario& scenario, const scenario::Platform& platform,
                                     double step_s) {
  const auto [begin_s, end_s] = presenceOf(scenario, platform);
  if (end_s < begin_s) return {};
  std::vector<double> times{begin_s};
  if (end_s > begin_s) times.push_back(end_s);
  if (!platform.moves()) return times;
  for (const scenario::TrackPoint& point : platform.track) {
    if (point.t_s > begin_s && point.t_s < end_s) times.push_back(point.t_s);
  }
  times = filled(std::move(times), step_s);
  times.erase(
      std::remove_if(times.begin(), times.end(), [&](double t_s) { return !platform.isPresentAt(t_s); }),
      times.end());  // in gaps of the track
  return times;
}

PoseSample poseOf(const scenario::Platform& platform, const scenario::Terrain* terrain, double t_s) {
  const scenario::TrackPoint point = scenario::pointAt(platform, t_s);
  const scenario::SitePosition& at = point.position;
  PoseSample pose;
  pose.t_s = t_s;
  pose.latitude_deg = at.latitude_deg;
  pose.longitude_deg = wrapLongitude_deg(at.longitude_deg);
  if (at.height_msl_m) {
    pose.height_msl_m = *at.height_msl_m;
  } else if (at.height_ellipsoid_m) {
    pose.height_msl_m = *at.height_ellipsoid_m - geoidUndulation_m(at.latitude_deg, at.longitude_deg);
  } else {
    const double ground_m = terrain == nullptr ? 0 : terrain->heightMsl_m(at.latitude_deg, at.longitude_deg);
    pose.height_msl_m = at.height_agl_m.value_or(0) + (std::isnan(ground_m) ? 0 : ground_m);
  }
  pose.heading_deg = point.heading_deg.value_or(0);
  pose.pitch_deg = point.pitch_deg.value_or(0);
  pose.roll_deg = point.roll_deg.value_or(0);
  return pose;
}

Domain domainOf(const scenario::Scenario& scenario, const scenario::Platform& platform,
                const scenario::Terrain* terrain) {
  const Presence presence = presenceOf(scenario, platform);
  const PoseSample begin = poseOf(platform, terrain, presence.begin_s);
  const double ground_m =
      terrain == nullptr ? std::nan("") : terrain->heightMsl_m(begin.latitude_deg, begin.longitude_deg);
  const double half_s = (presence.end_s - presence.begin_s) / 2;
  if (platform.moves() && half_s > 0) {
    const PoseSample middle = poseOf(platform, terrain, presence.begin_s + half_s);
    const double speed_mps = distance_m(begin, middle) / half_s;
    const double above_m = middle.height_msl_m - (std::isnan(ground_m) ? 0 : ground_m);
    if (speed_mps > 35 || above_m > 300) return Domain::air;
  }
  const bool is_sea =
      terrain == nullptr ? scenario.ground.kind == propagation::GroundKind::sea : ground_m <= 0;
  return is_sea ? Domain::sea : Domain::land;
}

BeamState beamStateAt(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double t_s) {
  using scenario::ScanKind;
  const scenario::ScanSpec& scan = emitter.scan;
  BeamState state;
  state.t_s = t_s;
  const scenario::Platform& platform = scenario.platforms[static_cast<std::size_t>(emitter.platform)];
  state.is_on = platform.isPresentAt(t_s) && scenario::isActiveAt(emitter, t_s);
  state.frequency_hz = emitter.frequency_hz;
  state.bandwidth_hz = emitter.bandwidth_hz;
  state.erp_dbm = ratioToDb(emitter.power_w) + 30 + emitter.antenna->gain_dbi - emitter.losses_db;
  state.power_dbm = ratioToDb(emitter.power_w) + 30;
  if (emitter.waveform) {
    state.prf_hz = emitter.waveform->prf_hz;
    state.pulse_width_s = emitter.waveform->pulse_width_s;
  }
  state.azimuth_deg = scan.azimuth_deg;
  state.elevation_deg = scan.elevation_deg;
  state.azimuth_half_sweep_deg = state.elevation_half_sweep_deg = 0;
  state.beamwidth_az_deg = emitter.antenna->beamwidth_az_deg;
  state.beamwidth_el_deg = emitter.antenna->beamwidth_el_deg;
  if (scan.kind == ScanKind::rotate) {
    state.azimuth_deg = 0;
    state.azimuth_half_sweep_deg = 180;
  } else if (scan.kind == ScanKind::sector || scan.kind == ScanKind::raster) {
    state.azimuth_half_sweep_deg = scan.width_deg / 2;
    if (scan.kind == ScanKind::raster)
      state.elevation_half_sweep_deg = scan.bars * scan.elevation_step_deg / 2;
  } else if (scan.kind == ScanKind::dwell_list) {
    const scenario::BeamDirection beam = scenario::beamAt(scan, t_s);
    state.azimuth_deg += beam.azimuth_deg;
    state.elevation_deg += beam.elevation_deg;
  }
  return state;
}

std::vector<double> timesOfChanges(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                   double step_s) {
  constexpr double kJustAfter_s = 0.001;
  const double duration_s = scenario.clock.duration_s;
  const Presence presence =
      presenceOf(scenario, scenario.platforms[static_cast<std::size_t>(emitter.platform)]);
  if (presence.end_s < presence.begin_s) return {};
  const double last_s = std::min(presence.end_s + kJustAfter_s, duration_s);
  std::vector<double> times{presence.begin_s, last_s};
  if (presence.end_s >= duration_s) times.pop_back();
  const auto add = [&](double t_s) {
    if (t_s > presence.begin_s && t_s <= last_s) times.push_back(t_s);
  };
  for (const scenario::TimeInterval& interval : emitter.active_s) {
    add(interval.begin_s);
    add(interval.end_s);
  }
  if (emitter.scan.kind == scenario::ScanKind::dwell_list) {
    const auto& dwells = emitter.scan.dwells;
    double cycle_s = 0;
    for (const scenario::Dwell& dwell : dwells) cycle_s += dwell.duration_s;
    // Many short dwells are sampled.
    constexpr double kMaxDwells = 100000;
    const double count = static_cast<double>(dwells.size()) * std::ceil(duration_s / cycle_s);
    if (!(count <= kMaxDwells)) {
      for (double t_s = step_s; t_s < duration_s; t_s += step_s) add(t_s);
    } else {
      double t_s = 0;
      for (std::size_t i = 0; t_s <= duration_s; ++i) {
        add(t_s);
        t_s += dwells[i % dwells.size()].duration_s;
      }
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

BeamWidths widthsOf(const BeamState& state) {
  const bool sweeps = state.azimuth_half_sweep_deg > 0;
  return {sweeps ? 2 * state.azimuth_half_sweep_deg : state.beamwidth_az_deg,
          std::max(state.beamwidth_el_deg, 2 * state.elevation_half_sweep_deg)};
}

Vec3d velocityAt_mps(const scenario::Platform& platform, const scenario::Terrain* terrain,
                     const std::vector<double>& times, std::size_t index) {
  if (!platform.moves() || index + 1 >= times.size()) return {0, 0, 0};
  const PoseSample a = poseOf(platform, terrain, times[index]),
                   b = poseOf(platform, terrain, times[index + 1]);
  const GeodesicInverse way =
      geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg);
  const double time_s = b.t_s - a.t_s, ground_mps = way.distance_m / time_s;
  return {ground_mps * std::sin(way.azimuth_rad), ground_mps * std::cos(way.azimuth_rad),
          (b.height_msl_m - a.height_msl_m) / time_s};
}

double drawnRange_m(const scenario::Scenario& scenario) {
  return std::round(scenario.region.size_m.x / 4);
}

double epochOf_s(const scenario::Scenario& scenario) {
  return utcSeconds(scenario.clock.epoch_utc).value_or(0);
}

void addRowsOfPlatforms(const scenario::Scenario& scenario, std::vector<ExportedRow>& rows) {
  std::vector<bool> has_row(scenario.platforms.size(), false);
  for (std::size_t i = 0; i < scenario.emitters.size(); ++i) {
    const auto platform = static_cast<std::size_t>(scenario.emitters[i].platform);
    if (has_row[platform]) continue;
    has_row[platform] = true;
    rows.push_back({"{object_name: " + quotedPattern(scenario.platforms[platform].name) + "}", i});
  }
}

std::string quotedPattern(std::string text) {
  for (char& c : text) {
    if (c == '*' || c == '[' || c == '|' || c == '?') c = '?';
  }
  return document::flowText(*textNode(text), true);
}

std::string databaseText(const scenario::Scenario& scenario, const std::vector<ExportedRow>& rows,
                         const std::string& folder) {
  if (!scenario.source || !scenario.source->root)
    throw Error(ErrorCode::bad_input, "the scenario was not read from a file; save it first");
  const DocumentNodePtr emitters = document::valueAt(scenario.source->root, {std::string("emitters")});
  std::string text = fmt::format(
      "# Emitters of the scenario {}, for emscape import: what the recording beside this file does not "
      "tell.\n"
      "schema_version: 1\nemitters:\n",
      document::flowText(*textNode(scenario.name), false));
  const fs::path from = fs::absolute(scenario.file).parent_path().lexically_normal();
  const fs::path to = fs::absolute(folder).lexically_normal();
  for (const ExportedRow& row : rows) {
    MapBuilder emitter(emitters->items[row.emitter]);
    const std::string name = emitter.textOf("name");
    emitter.remove("name").remove("platform").remove("active_s");
    MapBuilder antenna(emitter.find("antenna"));
    for (const char* key : {"file", "azimuth_file", "elevation_file"}) {
      const std::string file = antenna.textOf(key);
      if (file.empty() || fs::path(file).is_absolute()) continue;
      antenna.set(key, textNode((from / file).lexically_normal().lexically_relative(to).generic_string()));
    }
    emitter.set("antenna", antenna.node());
    text += "  - name: " + document::flowText(*textNode(name), false) + "\n    match: " + row.match +
            "\n    emitter:\n";
    for (const document::MapEntry& entry : emitter.entries())
      text += "      " + entry.key + ": " + document::flowText(*entry.value, false) + "\n";
  }
  return text;
}

}  // namespace emscape::interop
