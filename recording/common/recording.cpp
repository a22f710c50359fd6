#include "recording/common/recording.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "recording/common/samples.h"

namespace emscape::interop {
namespace {

bool sameValue(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

double lerp(double a, double b, double part) {
  return a + part * (b - a);
}

/// Between two angles (deg) over the shorter arc; unknown if one of them is.
double lerpAngle_deg(double a, double b, double part) {
  return wrapLongitude_deg(a + part * wrapLongitude_deg(b - a));
}

}  // namespace

bool sameState(const BeamState& a, const BeamState& b) {
  return a.is_on == b.is_on && a.target == b.target && sameValue(a.frequency_hz, b.frequency_hz) &&
         sameValue(a.bandwidth_hz, b.bandwidth_hz) && sameValue(a.erp_dbm, b.erp_dbm) &&
         sameValue(a.power_dbm, b.power_dbm) && sameValue(a.prf_hz, b.prf_hz) &&
         sameValue(a.pulse_width_s, b.pulse_width_s) && sameValue(a.azimuth_deg, b.azimuth_deg) &&
         sameValue(a.elevation_deg, b.elevation_deg) &&
         sameValue(a.azimuth_half_sweep_deg, b.azimuth_half_sweep_deg) &&
         sameValue(a.elevation_half_sweep_deg, b.elevation_half_sweep_deg) &&
         sameValue(a.beamwidth_az_deg, b.beamwidth_az_deg) &&
         sameValue(a.beamwidth_el_deg, b.beamwidth_el_deg);
}

void addPose(std::vector<PoseSample>& poses, const PoseSample& pose) {
  const auto rests = [&](const PoseSample& before) {
    return before.t_s <= pose.t_s && before.latitude_deg == pose.latitude_deg &&
           before.longitude_deg == pose.longitude_deg && before.height_msl_m == pose.height_msl_m &&
           sameValue(before.heading_deg, pose.heading_deg) && sameValue(before.pitch_deg, pose.pitch_deg) &&
           sameValue(before.roll_deg, pose.roll_deg);
  };
  if (!poses.empty() && poses.back().t_s == pose.t_s) {
    poses.back() = pose;
  } else if (poses.size() >= 2 && rests(poses.back()) && rests(poses[poses.size() - 2])) {
    poses.back().t_s = pose.t_s;
  } else {
    poses.push_back(pose);
  }
}

void addState(std::vector<BeamState>& states, const BeamState& state) {
  if (states.empty() ? !state.is_on : sameState(states.back(), state)) return;
  if (!states.empty() && states.back().t_s == state.t_s) {
    states.back() = state;
  } else {
    states.push_back(state);
  }
}

void addPresence(std::vector<PresenceSample>& presence, double t_s, bool is_present) {
  if ((presence.empty() || presence.back().is_present) == is_present) return;
  presence.push_back({t_s, is_present});
}

void sortByTime(RecordedObject& object) {
  const auto earlier = [](const auto& a, const auto& b) { return a.t_s < b.t_s; };
  if (!std::is_sorted(object.poses.begin(), object.poses.end(), earlier))
    std::stable_sort(object.poses.begin(), object.poses.end(), earlier);
  // Of several poses at one time the last that was read is kept.
  std::vector<PoseSample> distinct;
  distinct.reserve(object.poses.size());
  for (const PoseSample& pose : object.poses) {
    if (!distinct.empty() && distinct.back().t_s == pose.t_s) distinct.pop_back();
    distinct.push_back(pose);
  }
  object.poses = std::move(distinct);
  std::stable_sort(object.presence.begin(), object.presence.end(), earlier);
}

void sortByTime(RecordedBeam& beam) {
  std::stable_sort(beam.states.begin(), beam.states.end(),
                   [](const BeamState& a, const BeamState& b) { return a.t_s < b.t_s; });
}

void keepObjects(Recording& recording, const std::vector<bool>& is_kept) {
  std::vector<std::size_t> kept_as(recording.objects.size(), kNoTarget);
  std::vector<RecordedObject> objects;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    if (!is_kept[i]) continue;
    kept_as[i] = objects.size();
    objects.push_back(std::move(recording.objects[i]));
  }
  std::vector<RecordedBeam> beams;
  for (RecordedBeam& beam : recording.beams) {
    if (kept_as[beam.object] == kNoTarget) continue;
    beam.object = kept_as[beam.object];
    for (BeamState& state : beam.states) {
      if (state.target != kNoTarget) state.target = kept_as[state.target];
    }
    beams.push_back(std::move(beam));
  }
  recording.objects = std::move(objects);
  recording.beams = std::move(beams);
}

TimeSpan spanOf(const Recording& recording) {
  TimeSpan span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto include = [&span](double t_s) {
    span.begin_s = std::min(span.begin_s, t_s);
    span.end_s = std::max(span.end_s, t_s);
  };
  for (const RecordedObject& object : recording.objects) {
    if (!object.poses.empty()) {
      include(object.poses.front().t_s);
      include(object.poses.back().t_s);
    }
    for (const PresenceSample& sample : object.presence) include(sample.t_s);
  }
  for (const RecordedBeam& beam : recording.beams) {
    for (const BeamState& state : beam.states) include(state.t_s);
  }
  return span.begin_s <= span.end_s ? span : TimeSpan{};
}

std::string joinedName(const std::string& carrier, const std::string& part) {
  // Blanks around both, so that names begin and end with whole words.
  const std::string of_carrier = " " + carrier + " ", of_part = " " + part + " ";
  const bool part_has_carrier = of_part.rfind(of_carrier, 0) == 0;
  const bool carrier_has_part =
      of_carrier.rfind(of_part, 0) == 0 || (of_carrier.size() > of_part.size() &&
                                            of_carrier.substr(of_carrier.size() - of_part.size()) == of_part);
  return part_has_carrier ? part : carrier_has_part ? carrier : carrier + " " + part;
}

PoseSample poseAt(const RecordedObject& object, double t_s) {
  const auto& poses = object.poses;
  const auto after = std::upper_bound(poses.begin(), poses.end(), t_s,
                                      [](double t, const PoseSample& pose) { return t < pose.t_s; });
  if (after == poses.begin()) return poses.front();
  const PoseSample& a = *(after - 1);
  if (after == poses.end()) return a;
  const PoseSample& b = *after;
  const double part = (t_s - a.t_s) / (b.t_s - a.t_s);
  PoseSample pose;
  pose.t_s = t_s;
  pose.latitude_deg = lerp(a.latitude_deg, b.latitude_deg, part);
  pose.longitude_deg = lerpAngle_deg(a.longitude_deg, b.longitude_deg, part);
  pose.height_msl_m = lerp(a.height_msl_m, b.height_msl_m, part);
  pose.heading_deg = lerpAngle_deg(a.heading_deg, b.heading_deg, part);
  pose.pitch_deg = lerp(a.pitch_deg, b.pitch_deg, part);
  pose.roll_deg = lerpAngle_deg(a.roll_deg, b.roll_deg, part);
  return pose;
}

}  // namespace emscape::interop
