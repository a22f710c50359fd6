#include "interop/live/live_dis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "recording/dis/dead_reckoning.h"
#include "recording/dis/dis_recorder.h"

namespace emscape::interop {
namespace {

using dis::EmissionBeam;
using dis::EmissionSystem;
using dis::EntityState;

/// Time (s) after which a beam that is held on a target is directed anew.
constexpr double kHeldBeams_s = 1;

/// Differences that the importer takes as equal (docs/battlefield.md).
bool isSame(double a, double b, double relative, double absolute) {
  return a == b || std::abs(a - b) <= std::max(relative * std::max(std::abs(a), std::abs(b)), absolute) ||
         (std::isnan(a) && std::isnan(b));
}

bool isSameBeam(const EmissionBeam& a, const EmissionBeam& b) {
  constexpr double kAngle_rad = 0.5 * kPi / 180;
  const auto targetOf = [](const EmissionBeam& beam) {
    return beam.targets.empty() ? 0 : beam.targets.front().key();
  };
  return a.number == b.number && a.parameter_index == b.parameter_index && a.function == b.function &&
         a.is_off == b.is_off && targetOf(a) == targetOf(b) &&
         isSame(a.frequency_hz, b.frequency_hz, 1e-3, 0) &&
         isSame(a.frequency_range_hz, b.frequency_range_hz, 1e-2, 0) &&
         isSame(a.erp_dbm, b.erp_dbm, 0, 0.25) && isSame(a.prf_hz, b.prf_hz, 1e-2, 0) &&
         isSame(a.pulse_width_us, b.pulse_width_us, 1e-2, 0) &&
         isSame(a.azimuth_rad, b.azimuth_rad, 0, kAngle_rad) &&
         isSame(a.azimuth_sweep_rad, b.azimuth_sweep_rad, 0, kAngle_rad) &&
         isSame(a.elevation_rad, b.elevation_rad, 0, kAngle_rad) &&
         isSame(a.elevation_sweep_rad, b.elevation_sweep_rad, 0, kAngle_rad);
}

bool isSameSystem(const EmissionSystem& a, const EmissionSystem& b) {
  return a.name == b.name && a.function == b.function &&
         std::equal(a.beams.begin(), a.beams.end(), b.beams.begin(), b.beams.end(), isSameBeam);
}

bool isSameRadio(const dis::Transmitter& a, const dis::Transmitter& b) {
  return (a.state == 2) == (b.state == 2) && a.frequency_hz == b.frequency_hz &&
         isSame(a.bandwidth_hz, b.bandwidth_hz, 1e-2, 0) && isSame(a.power_dbm, b.power_dbm, 0, 0.25);
}

bool isSameEntity(const EntityState& a, const EntityState& b) {
  return a.force == b.force && a.type == b.type && a.marking == b.marking &&
         a.isDestroyed() == b.isDestroyed();
}

}  // namespace

void LiveDis::take(const std::uint8_t* bytes, std::size_t size, double arrival_s) {
  std::size_t at = 0;
  do {
    const auto header = dis::decodeHeader(bytes + at, size - at);
    if (!header) return countBad(at == 0 ? "a datagram that is no DIS" : "bytes after a PDU that are no PDU");
    ++counts_.records;
    takePdu(*header, bytes + at, arrival_s);
    at += header->length;
  } while (at + dis::kHeaderBytes <= size);
}

void LiveDis::takePdu(const dis::Header& header, const std::uint8_t* bytes, double arrival_s) {
  std::string fault;
  const bool is_other = header.exercise != exercise_.value_or(header.exercise);
  const bool is_over = !options_.exercise && arrival_s - exercise_heard_s_ > options_.entity_timeout_s;
  if (is_other && !is_over) {
    return countBad(fmt::format("a PDU of exercise {}; only those of exercise {} are taken", header.exercise,
                                *exercise_));
  }
  exercise_ = header.exercise;
  exercise_heard_s_ = arrival_s;
  switch (static_cast<dis::PduType>(header.type)) {
    case dis::PduType::entity_state:
      if (auto state = dis::decodeEntityState(bytes, header.length, fault)) {
        const double time_s = clocks_.timeOf(state->id, header, arrival_s);
        takeState(std::move(*state), time_s, arrival_s);
      }
      break;
    case dis::PduType::emission:
      if (const auto emission = dis::decodeEmission(bytes, header.length, fault))
        takeEmission(*emission, header.version, arrival_s);
      break;
    case dis::PduType::transmitter:
      if (const auto transmitter = dis::decodeTransmitter(bytes, header.length, fault))
        takeTransmitter(*transmitter, arrival_s);
      break;
    default:
      return;
  }
  if (!fault.empty()) countBad(fault);
}

LiveDis::Entity& LiveDis::entityOf(const dis::EntityId& id, double arrival_s) {
  const std::uint64_t key = id.key();
  const auto [found, is_new] = entities_.try_emplace(key);
  Entity& entity = found->second;
  if (is_new) {
    recent_.push_front(key);
    entity.recent = recent_.begin();
    if (entities_.size() > LiveLimits::kObjects) {
      ++counts_.forgotten;
      forget(recent_.back());
    }
  } else {
    recent_.splice(recent_.begin(), recent_, entity.recent);
  }
  entity.heard_s = arrival_s;
  return entity;
}

std::size_t LiveDis::beamCount(const Entity& entity) {
  std::size_t count = entity.radios.size();
  for (const auto& [number, system] : entity.systems) count += system.told.beams.size() + 1;
  return count;
}

void LiveDis::forget(std::uint64_t key) {
  const auto found = entities_.find(key);
  if (found->second.is_known) {
    --known_;
    ++revision_;
  }
  beams_ -= beamCount(found->second);
  recent_.erase(found->second.recent);
  entities_.erase(found);
}

void LiveDis::takeState(EntityState state, double time_s, double arrival_s) {
  Entity& entity = entityOf(state.id, arrival_s);
  if (entity.is_known && time_s < entity.time_s) {
    ++counts_.late;
    return;
  }
  if (entity.is_known && time_s == entity.time_s && state.position_m == entity.state.position_m) {
    ++counts_.duplicates;
    return;
  }
  if (!dis::poseSampleOf(state.position_m, dis::axesOf(state.orientation_rad))) {
    ++counts_.outside;
    return;
  }
  if (!entity.is_known || !isSameEntity(entity.state, state)) ++revision_;
  if (!entity.is_known) ++known_;
  entity.is_known = true;
  entity.state = std::move(state);
  entity.time_s = time_s;
}

void LiveDis::takeEmission(const dis::Emission& emission, int version, double arrival_s) {
  Entity& entity = entityOf(emission.entity, arrival_s);
  const std::size_t before = beamCount(entity);
  bool is_changed = false;
  if (emission.systems.empty()) {  // the entity has ceased to emit
    is_changed = !entity.systems.empty();
    entity.systems.clear();
  }
  for (const EmissionSystem& told : emission.systems) {
    EmissionSystem now = told;
    for (EmissionBeam& beam : now.beams) beam.targets.resize(std::min<std::size_t>(beam.targets.size(), 1));
    const auto known = entity.systems.find(told.number);
    // In version 7 a system may be told in part; before, a beam that is not listed is off.
    if (version > 6 && known != entity.systems.end() && !told.beams.empty()) {
      for (const EmissionBeam& beam : known->second.told.beams) {
        const bool is_told = std::any_of(now.beams.begin(), now.beams.end(),
                                         [&](const EmissionBeam& b) { return b.number == beam.number; });
        if (!is_told && now.beams.size() < 256) now.beams.push_back(beam);
      }
    }
    std::sort(now.beams.begin(), now.beams.end(),
              [](const EmissionBeam& a, const EmissionBeam& b) { return a.number < b.number; });
    if (known == entity.systems.end()) {
      if (beams_ + now.beams.size() + 1 > LiveLimits::kBeams) {
        ++counts_.forgotten;
        continue;
      }
      entity.systems.emplace(told.number, System{std::move(now), arrival_s});
      is_changed = true;
      continue;
    }
    known->second.heard_s = arrival_s;
    const std::size_t have = known->second.told.beams.size();
    if (now.beams.size() > have && beams_ + now.beams.size() - have > LiveLimits::kBeams) {
      ++counts_.forgotten;
      continue;
    }
    is_changed = is_changed || !isSameSystem(known->second.told, now);
    known->second.told = std::move(now);
  }
  beams_ = beams_ - before + beamCount(entity);
  if (is_changed && entity.is_known) ++revision_;
}

void LiveDis::takeTransmitter(const dis::Transmitter& transmitter, double arrival_s) {
  Entity& entity = entityOf(transmitter.entity, arrival_s);
  const auto known = entity.radios.find(transmitter.radio);
  if (known == entity.radios.end()) {
    if (beams_ >= LiveLimits::kBeams) {
      ++counts_.forgotten;
      return;
    }
    ++beams_;
    entity.radios.emplace(transmitter.radio, Radio{transmitter, arrival_s});
    if (entity.is_known) ++revision_;
    return;
  }
  if (entity.is_known && !isSameRadio(known->second.told, transmitter)) ++revision_;
  known->second = {transmitter, arrival_s};
}

void LiveDis::expire(double now_s) {
  while (!recent_.empty() && now_s - entities_[recent_.back()].heard_s > options_.entity_timeout_s)
    forget(recent_.back());
  bool has_held = false;
  for (auto& [key, entity] : entities_) {
    const std::size_t before = beamCount(entity);
    const auto dropOld = [&](auto& items) {
      for (auto item = items.begin(); item != items.end();) {
        const bool is_old = now_s - item->second.heard_s > options_.emission_timeout_s;
        item = is_old ? items.erase(item) : std::next(item);
      }
    };
    dropOld(entity.systems);
    dropOld(entity.radios);
    const std::size_t after = beamCount(entity);
    beams_ = beams_ - before + after;
    if (after != before && entity.is_known) ++revision_;
    for (const auto& [number, system] : entity.systems) {
      for (const EmissionBeam& beam : system.told.beams) has_held = has_held || !beam.targets.empty();
    }
  }
  if (has_held && now_s - held_beams_changed_s_ > kHeldBeams_s) {
    held_beams_changed_s_ = now_s;
    ++revision_;
  }
}

PoseSample LiveDis::poseOf(const Entity& entity, double now_s) const {
  const double past_s = std::clamp(now_s - entity.time_s, 0.0, options_.entity_timeout_s);
  const dis::ReckonedPose at = dis::reckonedPose(entity.state, past_s);
  // A velocity that nothing has leads away from the earth.
  const double radius_m = length(at.position_m);
  std::optional<PoseSample> pose;
  if (radius_m > 6.2e6 && radius_m < 7e6) pose = dis::poseSampleOf(at.position_m, at.axes);
  if (!pose) pose = dis::poseSampleOf(entity.state.position_m, dis::axesOf(entity.state.orientation_rad));
  return pose.value();  // takeState() has checked that
}

std::vector<LivePose> LiveDis::poses(double now_s) const {
  std::vector<LivePose> poses;
  poses.reserve(known_);
  for (const auto& [key, entity] : entities_) {
    if (entity.is_known) poses.push_back({key, poseOf(entity, now_s)});
  }
  return poses;
}

LiveRecording LiveDis::recording(double now_s) {
  LiveRecording result;
  for (const auto& [key, entity] : entities_) {
    if (entity.is_known) result.keys.push_back(key);
  }
  std::sort(result.keys.begin(), result.keys.end());
  dis::DisRecorder recorder(options_);
  for (const std::uint64_t key : result.keys) recorder.takeState(entities_[key].state, 0);
  for (const std::uint64_t key : result.keys) {
    const Entity& entity = entities_[key];
    if (entity.state.isDestroyed()) continue;
    dis::Emission emission;
    emission.entity = entity.state.id;
    for (const auto& [number, system] : entity.systems) {
      emission.systems.push_back(system.told);
      for (EmissionBeam& beam : emission.systems.back().beams) {
        const auto target = beam.targets.empty() ? entities_.end() : entities_.find(beam.targets[0].key());
        if (target == entities_.end() || !target->second.is_known) beam.targets.clear();
      }
    }
    if (!emission.systems.empty()) recorder.takeEmission(emission, 0, 7);
    for (const auto& [number, radio] : entity.radios) recorder.takeTransmitter(radio.told, 0);
  }
  result.recording = recorder.finish();
  for (std::size_t i = 0; i < result.keys.size(); ++i) {
    std::vector<PoseSample>& poses = result.recording.objects[i].poses;
    poses = {poseOf(entities_[result.keys[i]], now_s)};
  }
  return result;
}

}  // namespace emscape::interop
