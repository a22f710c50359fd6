#include "study/picture/map_objects.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/scenario/model/snapshot.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::study {

render::Rgb pointColorOf(const scenario::Emitter& emitter) {
  constexpr render::Rgb kOff{0.6F, 0.6F, 0.6F};
  return emitter.enabled ? render::colorOf(playback::markerKindOf(emitter.kind)) : kOff;
}

std::vector<MapEmitter> emittersOf(const MapStudy& study) {
  const auto& scenario = study.scenarios.front();
  std::vector<MapEmitter> emitters;
  for (const scenario::Emitter& emitter : scenario->emitters) {
    const scenario::Platform& platform = scenario->platforms[emitter.platform];
    emitters.push_back({&emitter, platform.name, platform.moves(), {}});
  }
  for (const double time_s : study.times_s) {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, study.terrain.get(), time_s);
    for (std::size_t e = 0; e < emitters.size(); ++e) {
      const int platform = scenario->emitters[e].platform;
      if (!emitters[e].is_moving && !emitters[e].positions.empty()) continue;
      if (!snapshot.platforms[static_cast<std::size_t>(platform)].present) continue;
      const scenario::EmitterState& state = snapshot.emitters[e];
      emitters[e].positions.push_back({time_s, state.position, state.height_msl_m});
    }
  }
  return emitters;
}

std::vector<MapSite> sitesOf(const MapStudy& study) {
  const auto& scenario = study.scenarios.front();
  std::vector<MapSite> sites;
  for (const scenario::Platform& platform : scenario->platforms) {
    sites.push_back({platform.name, platform.moves(), {}, {}, {}, {}});
  }
  const auto carry = [&](const auto& items, std::vector<std::string> MapSite::*names) {
    for (const auto& item : items)
      (sites[static_cast<std::size_t>(item.platform)].*names).push_back(item.name);
  };
  carry(scenario->emitters, &MapSite::emitters);
  carry(scenario->placed_receivers, &MapSite::receivers);
  carry(scenario->targets, &MapSite::targets);
  for (const double time_s : study.times_s) {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, study.terrain.get(), time_s);
    for (std::size_t p = 0; p < sites.size(); ++p) {
      if (!sites[p].is_moving && !sites[p].positions.empty()) continue;
      const scenario::PlatformState& state = snapshot.platforms[p];
      if (!state.present) continue;
      sites[p].positions.push_back({time_s, state.position, state.height_msl_m});
    }
  }
  return sites;
}

std::vector<MapTrack> tracksOf(const MapStudy& study) {
  const auto& scenario = study.scenarios.front();
  const double duration_s = scenario->clock.duration_s;
  std::vector<MapTrack> tracks;
  for (std::size_t p = 0; p < scenario->platforms.size(); ++p) {
    const scenario::Platform& platform = scenario->platforms[p];
    if (!platform.moves()) continue;
    std::vector<double> times_s = study.times_s;
    for (const scenario::TrackPoint& point : platform.track) times_s.push_back(point.t_s);
    if (duration_s > 0) times_s.insert(times_s.end(), {0, duration_s});
    std::sort(times_s.begin(), times_s.end());
    times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
    MapTrack track{&platform, {}};
    for (const double time_s : times_s) {
      if (!platform.isPresentAt(time_s)) continue;
      if (duration_s > 0 && (time_s < 0 || time_s > duration_s)) continue;
      try {
        const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, study.terrain.get(), time_s);
        const scenario::PlatformState& state = snapshot.platforms[p];
        track.positions.push_back({time_s, state.position, state.height_msl_m});
      } catch (const Error&) {
        continue;  // the terrain is missing there
      }
    }
    if (track.positions.size() > 1) tracks.push_back(std::move(track));
  }
  return tracks;
}

std::vector<MapTrack> cutAtAntimeridian(const MapTrack& track) {
  std::vector<MapTrack> parts{{track.platform, {}}};
  for (const MapPosition& to : track.positions) {
    std::vector<MapPosition>& part = parts.back().positions;
    const MapPosition from = part.empty() ? to : part.back();
    const double east_deg = wrapLongitude_deg(to.position.longitude_deg - from.position.longitude_deg);
    if (std::abs(to.position.longitude_deg - from.position.longitude_deg) > 180 && east_deg != 0) {
      const double border_deg = std::copysign(180.0, east_deg);
      const double share = (border_deg - from.position.longitude_deg) / east_deg;
      const auto between = [&](double begin, double end) { return begin + share * (end - begin); };
      MapPosition border = from;
      border.time_s = between(from.time_s, to.time_s);
      border.position.latitude_deg = between(from.position.latitude_deg, to.position.latitude_deg);
      border.height_msl_m = between(from.height_msl_m, to.height_msl_m);
      border.position.longitude_deg = border_deg;
      part.push_back(border);
      border.position.longitude_deg = -border_deg;
      parts.push_back({track.platform, {border}});
    }
    parts.back().positions.push_back(to);
  }
  return parts;
}

std::string utcOf(const MapStudy& study, double time_s) {
  scenario::Clock clock = study.scenarios.front()->clock;
  if (clock.epoch_utc.empty()) clock.epoch_utc = "1970-01-01T00:00:00Z";
  return scenario::utcAt(clock, time_s);
}

double endOf(const MapStudy& study, double time_s) {
  const std::vector<double>& times_s = study.times_s;
  const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  if (next != times_s.end()) return *next;
  const double end_s = time_s + (times_s.size() > 1 ? times_s.back() - times_s[times_s.size() - 2] : 1);
  return utcOf(study, end_s).empty() ? time_s : end_s;
}

}  // namespace emscape::study
