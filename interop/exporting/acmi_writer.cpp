#include <fmt/format.h>

#include <algorithm>

#include "interop/exporting/writers.h"
#include "interop/importing/nodes.h"
#include "recording/acmi/acmi_text.h"

namespace emscape::interop {
namespace {

std::string typeOf(Domain domain) {
  if (domain == Domain::air) return "Air+FixedWing";
  return domain == Domain::sea ? "Sea+Watercraft" : "Ground+Vehicle";
}

/// Properties of a side. Names of coalitions are free; programs tell the sides by the colours.
std::string sideOf(const scenario::Platform& platform) {
  switch (platform.side.value_or(scenario::Side::unknown)) {
    case scenario::Side::friendly:
      return ",Coalition=Friend,Color=Blue";
    case scenario::Side::hostile:
      return ",Coalition=Hostile,Color=Red";
    case scenario::Side::neutral:
      return ",Coalition=Neutral,Color=Green";
    case scenario::Side::unknown:
      break;
  }
  return "";
}

/// An object of the recording.
struct AcmiObject {
  int id = 0;
  const scenario::Platform* platform = nullptr;
  const scenario::Emitter* emitter = nullptr;  ///< whose beam it has; null: none
  std::string properties;                      ///< of its first line
  std::string place, radar;                    ///< as last written
};

std::string placeOf(const PoseSample& pose) {
  return fmt::format("T={}|{}|{}|{}|{}|{}", decimalText(pose.longitude_deg, 7),
                     decimalText(pose.latitude_deg, 7), decimalText(pose.height_msl_m, 2),
                     decimalText(pose.roll_deg, 2), decimalText(pose.pitch_deg, 2),
                     decimalText(pose.heading_deg, 2));
}

/// The beam's properties; of one that sweeps the beamwidth of the sector, as other programs write it.
std::string radarOf(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double t_s) {
  const BeamState state = beamStateAt(scenario, emitter, t_s);
  const BeamWidths widths = widthsOf(state);
  return fmt::format(
      "RadarMode={},RadarAzimuth={},RadarElevation={},RadarHorizontalBeamwidth={},RadarVerticalBeamwidth={}",
      state.is_on ? 1 : 0, decimalText(state.azimuth_deg, 2), decimalText(state.elevation_deg, 2),
      decimalText(widths.azimuth_deg, 3), decimalText(widths.elevation_deg, 3));
}

std::vector<AcmiObject> objectsOf(const ExportJob& job, std::vector<ExportedRow>& rows) {
  const scenario::Scenario& scenario = job.scenario;
  std::vector<AcmiObject> objects;
  for (const scenario::Platform& platform : scenario.platforms) {
    AcmiObject object;
    object.id = static_cast<int>(objects.size()) + 1;
    object.platform = &platform;
    object.properties = fmt::format(",Type={},Name={}{}", typeOf(domainOf(scenario, platform, job.terrain)),
                                    escapedAcmi(platform.name), sideOf(platform));
    objects.push_back(object);
  }
  for (std::size_t i = 0; i < scenario.emitters.size(); ++i) {
    const scenario::Emitter& emitter = scenario.emitters[i];
    AcmiObject& carrier = objects[static_cast<std::size_t>(emitter.platform)];
    if (emitter.kind == scenario::EmitterKind::radar && carrier.emitter == nullptr) {
      carrier.emitter = &emitter;
      rows.push_back({fmt::format("{{acmi_name: {}}}", quotedPattern(carrier.platform->name)), i});
      continue;
    }
    AcmiObject beam;
    beam.id = static_cast<int>(objects.size()) + 1;
    beam.platform = carrier.platform;
    beam.emitter = &emitter;
    beam.properties = fmt::format(",Type=Beam,Name={},Parent={:x}", escapedAcmi(emitter.name), carrier.id);
    rows.push_back({fmt::format("{{acmi_type: Beam, acmi_name: {}, object_name: {}}}",
                                quotedPattern(emitter.name), quotedPattern(carrier.platform->name)),
                    i});
    objects.push_back(beam);
  }
  // A platform may have the name of an emitter: the rows of objects of type Beam come first.
  std::stable_partition(rows.begin(), rows.end(),
                        [](const ExportedRow& row) { return row.match.rfind("{acmi_type", 0) == 0; });
  return objects;
}

}  // namespace

long long writeAcmi(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows) {
  const scenario::Scenario& scenario = job.scenario;
  std::vector<AcmiObject> objects = objectsOf(job, rows);
  std::vector<std::pair<double, std::size_t>> events;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (const double t_s : timesOfPositions(scenario, *objects[i].platform, job.step_s))
      events.emplace_back(t_s, i);
    if (objects[i].emitter == nullptr) continue;
    const double end_s = presenceOf(scenario, *objects[i].platform).end_s;
    for (const double t_s : timesOfChanges(scenario, *objects[i].emitter, job.step_s)) {
      if (t_s <= end_s) events.emplace_back(t_s, i);
    }
  }
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end()), events.end());
  sink(
      "\xEF\xBB\xBF"
      "FileType=text/acmi/tacview\nFileVersion=2.2\n");
  if (!scenario.clock.epoch_utc.empty()) sink("0,ReferenceTime=" + scenario.clock.epoch_utc + "\n");
  sink("0,Title=" + escapedAcmi(scenario.name) + "\n0,DataSource=Emscape\n0,DataRecorder=Emscape\n");
  double frame_s = -1;
  long long records = 0;
  for (std::size_t e = 0; e < events.size(); ++e) {
    const auto [t_s, index] = events[e];
    if (job.progress && e % 1000 == 0)
      job.progress("writing ACMI", static_cast<double>(e) / static_cast<double>(events.size()));
    AcmiObject& object = objects[index];
    const bool is_new = object.place.empty();
    const std::string place = placeOf(poseOf(*object.platform, job.terrain, t_s));
    const std::string radar = object.emitter == nullptr ? "" : radarOf(scenario, *object.emitter, t_s);
    std::string line;
    // The end of a platform's stay is written, so that the recording is as long as the scenario.
    const bool is_last = t_s >= scenario.clock.duration_s;
    if (place != object.place || is_last) line += "," + place;
    if (is_new) line += object.properties;
    if (radar != object.radar) line += "," + radar;
    object.place = place;
    object.radar = radar;
    const double end_s = presenceOf(scenario, *object.platform).end_s;
    const bool leaves = t_s >= end_s && end_s < scenario.clock.duration_s;
    if (line.empty() && !leaves) continue;
    if (t_s != frame_s) sink(fmt::format("#{}\n", decimalText(t_s, 3)));
    frame_s = t_s;
    if (!line.empty()) sink(fmt::format("{:x}{}\n", object.id, line));
    if (leaves) sink(fmt::format("-{:x}\n", object.id));
    ++records;
  }
  return records;
}

}  // namespace emscape::interop
