#include "interop/live/live_cot.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/geodesy/position_limits.h"
#include "recording/common/samples.h"
#include "recording/cot/cot_reader.h"

namespace emscape::interop {
namespace {

/// An event so much (s) before its last one is not late: the sender's clock has been set back.
constexpr double kLatest_s = 30;
constexpr double kLongestLife_s = 86400;  ///< of an event, whatever it says

bool isPosition(const PoseSample& pose) {
  return std::abs(pose.latitude_deg) <= PositionLimits::kLatitude_deg &&
         std::abs(pose.longitude_deg) <= 720 && pose.height_msl_m >= PositionLimits::kLowest_m &&
         pose.height_msl_m <= PositionLimits::kHighest_m;
}

}  // namespace

void LiveCot::take(const std::uint8_t* bytes, std::size_t size, double arrival_s) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  constexpr char kProtobuf = '\xBF';  // the first byte of version 1 of the protocol
  if (!text.empty() && text.front() == kProtobuf) {
    ++counts_.records;
    return countBad("version 1 of TAK's protocol (protobuf); only version 0, XML, is read");
  }
  if (!is_text_) splitter_ = {};
  const long long before = counts_.records, dropped = splitter_.dropped();
  splitter_.take(text, [&](std::string_view event) { takeEvent(event, arrival_s); });
  for (long long i = dropped; i < splitter_.dropped(); ++i) countBad("an event longer than 1 MiB");
  if (!is_text_ && counts_.records == before) {
    ++counts_.records;
    countBad("a datagram without an <event>");
  }
}

void LiveCot::takeEvent(std::string_view xml, double arrival_s) {
  ++counts_.records;
  std::string fault;
  auto event = parseCotEvent(xml, fault);
  if (!event) return countBad(fault);
  if (!event->removed.empty()) return forget(event->removed);
  if (!event->isUsed()) return;
  if (!isPosition(event->pose)) return countBad(event->uid + ": its point is no position");
  keep(std::move(*event), arrival_s);
}

/// What a scenario of the event depends on, its position apart; angles to half a degree.
std::size_t LiveCot::structureOf(const CotEvent& event) const {
  std::string text = event.type + '\n' + event.callsign + '\n' + event.sensor_name + '\n' + event.carrier;
  const auto add = [&text](double angle_deg) {
    text += '\n' + std::to_string(std::isnan(angle_deg) ? 100000 : std::lround(2 * angle_deg));
  };
  if (event.has_sensor) {
    add(event.sensor.azimuth_deg);
    add(event.sensor.elevation_deg);
    add(event.sensor.beamwidth_az_deg);
    add(event.sensor.beamwidth_el_deg);
  }
  // Directions of sensors are from true north: on a carrier that turns they change.
  if (event.has_sensor || carriers_.count(event.uid) != 0) add(event.pose.heading_deg);
  return std::hash<std::string>()(text);
}

void LiveCot::keep(CotEvent event, double arrival_s) {
  const auto [found, is_new] = kept_.try_emplace(event.uid);
  Kept& kept = found->second;
  if (is_new) {
    kept.key = ++last_key_;
    by_key_[kept.key] = &kept;
    recent_.push_front(event.uid);
    kept.recent = recent_.begin();
  } else {
    const double before_s = kept.event.time_s - event.time_s;
    if (before_s > 0 && before_s <= kLatest_s) {
      ++counts_.late;
      return;
    }
    const PoseSample &told = event.pose, &last = kept.event.pose;
    if (event.time_s == kept.event.time_s && told.latitude_deg == last.latitude_deg &&
        told.longitude_deg == last.longitude_deg)
      ++counts_.duplicates;
    recent_.splice(recent_.begin(), recent_, kept.recent);
  }
  const auto carrierOf = [](const CotEvent& of) {
    return of.has_sensor ? of.sensorCarrier() : std::string();
  };
  const std::string before = carrierOf(kept.event), now = carrierOf(event);
  if (!is_new && !event.has_height && kept.event.has_height) {
    event.pose.height_msl_m = kept.event.pose.height_msl_m;
    event.has_height = true;
  }
  if (before != now) {
    if (!before.empty() && --carriers_[before] == 0) carriers_.erase(before);
    if (!now.empty()) ++carriers_[now];
  }
  kept.until_s = arrival_s + std::clamp(event.stale_s - event.time_s, 0.0, kLongestLife_s);
  const std::size_t structure = structureOf(event);
  if (is_new || structure != kept.structure) ++revision_;
  kept.structure = structure;
  kept.event = std::move(event);
  if (kept_.size() <= LiveLimits::kObjects) return;
  ++counts_.forgotten;
  forget(recent_.back());
}

void LiveCot::forget(const std::string& uid) {
  const auto found = kept_.find(uid);
  if (found == kept_.end()) return;
  const CotEvent& event = found->second.event;
  if (event.has_sensor) {
    const auto carrier = carriers_.find(event.sensorCarrier());
    if (carrier != carriers_.end() && --carrier->second == 0) carriers_.erase(carrier);
  }
  by_key_.erase(found->second.key);
  const auto recent = found->second.recent;
  kept_.erase(found);
  recent_.erase(recent);
  ++revision_;
}

void LiveCot::expire(double now_s) {
  std::vector<std::string> stale;
  for (const auto& [uid, kept] : kept_) {
    if (now_s > kept.until_s) stale.push_back(uid);
  }
  for (const std::string& uid : stale) forget(uid);
}

LiveRecording LiveCot::recording(double) {
  CotReader reader(ReadOptions{});
  for (const auto& [key, kept] : by_key_) {
    CotEvent event = kept->event;  // all of them now
    event.time_s = event.pose.t_s = event.sensor.t_s = 0;
    event.stale_s = 1;
    reader.take(event, event.uid);
  }
  LiveRecording live{reader.finish(), {}};
  Recording& recording = live.recording;
  recording.epoch_ms.reset();
  recording.tally = {};
  std::vector<bool> has_place;  // the carrier of a sensor may not have told of itself yet
  for (const RecordedObject& object : recording.objects) has_place.push_back(!object.poses.empty());
  keepObjects(recording, has_place);
  for (const RecordedObject& object : recording.objects) live.keys.push_back(kept_.at(object.id).key);
  return live;
}

std::vector<LivePose> LiveCot::poses(double) const {
  std::vector<LivePose> poses;
  for (const auto& [key, kept] : by_key_) {
    if (!kept->event.hasPlace()) continue;
    poses.push_back({key, withAnglesInRange(kept->event.pose)});
    PoseSample& pose = poses.back().pose;
    pose.t_s = 0;
    pose.longitude_deg = std::remainder(pose.longitude_deg, 360);
    const auto known = [](double& angle_deg) {
      if (std::isnan(angle_deg)) angle_deg = 0;
    };
    known(pose.heading_deg);
    known(pose.pitch_deg);
    known(pose.roll_deg);
  }
  return poses;
}

std::size_t LiveCot::objectCount() const {
  return static_cast<std::size_t>(std::count_if(
      kept_.begin(), kept_.end(), [](const auto& entry) { return entry.second.event.hasPlace(); }));
}

}  // namespace emscape::interop
