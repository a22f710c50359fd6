#include "recording/acmi/carried_beams.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "recording/acmi/acmi_text.h"
#include "recording/beams/directions.h"
#include "recording/common/samples.h"

namespace emscape::interop {
namespace {

constexpr double kNear_m = 50;
constexpr double kNear_deg = kNear_m / 110000;  ///< a degree of latitude is longer than that
constexpr int kMaxSearched = 2000;              ///< beams without a parent, each compared with all objects
/// Directions that differ less (deg) are those of the carrier.
constexpr double kAligned_deg = 0.1;

bool isPresentAt(const RecordedObject& object, double t_s) {
  bool is_present = t_s >= object.poses.front().t_s;
  for (const PresenceSample& sample : object.presence) {
    if (sample.t_s > t_s) break;
    is_present = sample.is_present;
  }
  return is_present;
}

using IndicesById = std::unordered_multimap<std::string, std::size_t>;

/// The object of an id that carries a beam; kNoTarget if there is none. Ids are used again: the one that is
/// present, else the last one.
std::size_t parentOf(const Recording& recording, const IndicesById& indices, std::size_t beam,
                     const std::string& parent) {
  const double begin_s = recording.objects[beam].poses.front().t_s;
  std::size_t found = kNoTarget;
  bool found_is_present = false;
  const auto [begin, end] = indices.equal_range(parent);
  for (auto item = begin; item != end; ++item) {
    const RecordedObject& object = recording.objects[item->second];
    if (item->second == beam || isAcmiBeam(object.type) || object.poses.empty()) continue;
    const bool is_present = isPresentAt(object, begin_s);
    const bool is_better = found == kNoTarget || (is_present && !found_is_present) ||
                           (is_present == found_is_present && item->second > found);
    if (!is_better) continue;
    found = item->second;
    found_is_present = is_present;
  }
  return found;
}

/// The nearest object that can carry a beam; kNoTarget if there is none.
std::size_t nearestTo(const Recording& recording, std::size_t beam) {
  const double begin_s = recording.objects[beam].poses.front().t_s;
  std::size_t found = kNoTarget;
  const PoseSample at = poseAt(recording.objects[beam], begin_s);
  const Vec3d spot_m = spotOf(at);
  double nearest_m = kNear_m;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    const RecordedObject& object = recording.objects[i];
    const bool can_carry = !isAcmiBeam(object.type) && !object.poses.empty() &&
                           object.domain != Domain::scenery && object.domain != Domain::weapon;
    if (!can_carry || !isPresentAt(object, begin_s)) continue;
    const PoseSample there = poseAt(object, begin_s);
    if (std::abs(there.latitude_deg - at.latitude_deg) > kNear_deg) continue;  // the most, and quickly
    const double distance_m = length(spotOf(there) - spot_m);
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    found = i;
  }
  return found;
}

bool isAligned(const RecordedObject& object, const RecordedObject& carrier) {
  return std::all_of(object.poses.begin(), object.poses.end(), [&](const PoseSample& pose) {
    if (std::isnan(pose.heading_deg)) return true;
    const RelativeDirection ahead = turned({}, axesAt(object, pose.t_s), axesAt(carrier, pose.t_s));
    return std::max(std::abs(ahead.azimuth_deg), std::abs(ahead.elevation_deg)) < kAligned_deg;
  });
}

/// The states of a beam's object in the axes of its carrier.
std::vector<BeamState> statesOn(const RecordedObject& carrier, const RecordedObject& object,
                                const std::vector<BeamState>& told) {
  std::vector<BeamState> states;
  if (told.empty()) return states;
  const bool is_aligned = isAligned(object, carrier);
  std::set<double> times;
  for (const BeamState& state : told) times.insert(state.t_s);
  for (const PresenceSample& sample : object.presence) times.insert(sample.t_s);
  if (!is_aligned) {
    for (const PoseSample& pose : object.poses) times.insert(pose.t_s);
  }
  std::size_t next = 0;
  for (const double t_s : times) {
    while (next < told.size() && told[next].t_s <= t_s) ++next;
    if (next == 0) continue;
    BeamState state = told[next - 1];
    state.t_s = t_s;
    state.is_on = state.is_on && isPresentAt(object, t_s);
    if (!is_aligned) {
      const RelativeDirection own{std::isnan(state.azimuth_deg) ? 0 : state.azimuth_deg,
                                  std::isnan(state.elevation_deg) ? 0 : state.elevation_deg};
      const RelativeDirection direction = turned(own, axesAt(object, t_s), axesAt(carrier, t_s));
      state.azimuth_deg = direction.azimuth_deg;
      state.elevation_deg = direction.elevation_deg;
    }
    addState(states, state);
  }
  return states;
}

}  // namespace

void joinCarriedBeams(Recording& recording, const std::unordered_map<std::size_t, std::string>& parents) {
  std::vector<bool> is_kept(recording.objects.size(), true);
  std::vector<std::size_t> carriers(recording.objects.size(), kNoTarget);
  IndicesById indices;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) indices.emplace(recording.objects[i].id, i);
  int searched = 0;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    const RecordedObject& object = recording.objects[i];
    if (!isAcmiBeam(object.type) || object.poses.empty()) continue;
    const auto parent = parents.find(i);
    if (parent != parents.end()) {
      carriers[i] = parentOf(recording, indices, i, parent->second);
    } else if (searched++ < kMaxSearched) {
      carriers[i] = nearestTo(recording, i);
    }
    is_kept[i] = carriers[i] == kNoTarget;
  }
  for (RecordedBeam& beam : recording.beams) {
    const std::size_t index = beam.object;
    for (BeamState& state : beam.states) {
      if (state.target != kNoTarget && !is_kept[state.target]) state.target = carriers[state.target];
    }
    if (is_kept[index]) continue;
    const RecordedObject& object = recording.objects[index];
    const RecordedObject& carrier = recording.objects[carriers[index]];
    beam.object = carriers[index];
    beam.name = object.keys.acmi_name.empty() ? "beam" : object.keys.acmi_name;
    beam.keys.acmi_name = object.keys.acmi_name;
    beam.keys.acmi_type = object.type;
    const double begin_s = object.poses.front().t_s;
    beam.height_m =
        std::clamp(object.poses.front().height_msl_m - poseAt(carrier, begin_s).height_msl_m, -100.0, 100.0);
    beam.states = statesOn(carrier, object, beam.states);
  }
  keepObjects(recording, is_kept);
}

}  // namespace emscape::interop
