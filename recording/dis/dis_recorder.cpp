#include "recording/dis/dis_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_limits.h"
#include "base/text/count_text.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/dis/dead_reckoning.h"
#include "recording/dis/force.h"

namespace emscape::interop::dis {
namespace {

/// Arrivals after this time (s) count from 1970.
constexpr double kUnixTime_s = 1e8;
/// Effective radiated powers above it (dBm) are in watts: 10^17 W do not exist, and senders confuse the
/// units.
constexpr double kMaxErp_dbm = 200;
constexpr double kMaxTime_s = 9.9e7;  ///< of a scenario's track, and some hours less
/// Functions of beams (SISO-REF-010, UID 78).
constexpr int kTrack = 4, kJam = 12, kIff = 13, kTimeSharedJam = 25;

Domain domainOf(const std::array<int, 7>& type) {
  switch (type[0]) {
    case 1: {  // platforms
      constexpr Domain kDomains[] = {Domain::other, Domain::land,       Domain::air,
                                     Domain::sea,   Domain::subsurface, Domain::space};
      return type[1] >= 0 && type[1] <= 5 ? kDomains[type[1]] : Domain::other;
    }
    case 2:
      return Domain::weapon;
    case 3:  // life forms
    case 5:  // cultural features
      return Domain::land;
    case 4:  // environmental
    case 6:  // supplies
    case 8:  // expendables
      return Domain::scenery;
    default:
      return Domain::other;
  }
}

std::string textOf(const EntityId& id) {
  return fmt::format("{}:{}:{}", id.site, id.application, id.entity);
}

/// A marking as printable text.
std::string markingText(const std::string& marking) {
  std::string text;
  for (const char c : marking) text += c >= 0x20 && c < 0x7F ? c : '?';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// A positive number, else unknown.
double known(double value) {
  return std::isfinite(value) && value > 0 ? value : kUnknown;
}

double knownAngle_deg(double angle_rad) {
  return std::isfinite(angle_rad) ? radToDeg(std::remainder(angle_rad, 2 * kPi)) : 0;
}

BeamKind kindOf(int function) {
  if (function == kJam || function == kTimeSharedJam) return BeamKind::jammer;
  return function == kIff ? BeamKind::transmitter : BeamKind::radar;
}

BeamState stateOf(const EmissionBeam& beam, double time_s) {
  BeamState state;
  state.t_s = time_s;
  state.is_on = !beam.is_off;
  state.frequency_hz = known(beam.frequency_hz);
  state.bandwidth_hz = known(beam.frequency_range_hz);
  state.prf_hz = known(beam.prf_hz);
  state.pulse_width_s = known(beam.pulse_width_us * 1e-6);
  state.azimuth_deg = knownAngle_deg(beam.azimuth_rad);
  state.elevation_deg = std::clamp(knownAngle_deg(beam.elevation_rad), -90.0, 90.0);
  const double sweep = std::isfinite(beam.azimuth_sweep_rad) ? std::abs(beam.azimuth_sweep_rad) : 0;
  // A search beam without centre and sweep turns all around; one that tracks or jams is held.
  const bool searches = beam.function < kTrack || beam.function > kJam;
  const bool turns = sweep > kPi - 1e-3 || (searches && sweep == 0 && beam.azimuth_rad == 0);
  state.azimuth_half_sweep_deg = turns ? 180 : radToDeg(sweep);
  const double rise = std::isfinite(beam.elevation_sweep_rad) ? std::abs(beam.elevation_sweep_rad) : 0;
  state.elevation_half_sweep_deg = std::min(radToDeg(rise), 90.0);
  return state;
}

/// Largest difference (m) between the straight line and the reckoned path that is not written out.
constexpr double kStraight_m = 0.5;
/// A larger correction (m) at the end of the path is a jump.
constexpr double kJump_m = 50;

}  // namespace

void DisRecorder::countSample() {
  if (++samples_ > RecordingLimits::kSamples) {
    throw Error(ErrorCode::bad_input,
                fmt::format("more than {} positions and states; cut the recording into parts with editcap",
                            RecordingLimits::kSamples));
  }
}

void DisRecorder::take(const Datagram& datagram) {
  std::size_t at = 0;
  while (at + kHeaderBytes <= datagram.size) {
    const auto header = decodeHeader(datagram.bytes + at, datagram.size - at);
    if (!header) {
      if (at == 0) return countIgnored(recording_.tally, "datagrams other than DIS");
      return countBad(recording_.tally, fmt::format("record {}", recording_.tally.records),
                      "the datagram goes on with bytes that are no PDU");
    }
    takePdu(*header, datagram.bytes + at, datagram.arrival_s);
    at += header->length;
  }
}

void DisRecorder::takePdu(const Header& header, const std::uint8_t* bytes, double arrival_s) {
  ReadingTally& tally = recording_.tally;
  ++tally.records;
  if (!has_begun_) {
    has_begun_ = true;
    origin_s_ = std::floor(arrival_s);
    if (origin_s_ > kUnixTime_s && origin_s_ < 2e11) recording_.epoch_ms = std::llround(origin_s_ * 1000);
  }
  lowest_version_ = std::min<int>(lowest_version_, header.version);
  highest_version_ = std::max<int>(highest_version_, header.version);
  const auto type = static_cast<PduType>(header.type);
  const bool is_used =
      type == PduType::entity_state || type == PduType::emission || type == PduType::transmitter;
  if (!is_used) return countIgnored(tally, nameOf(header.type) + " PDU");
  // Entities of another exercise have the same numbers.
  if (header.exercise != exercise_.value_or(header.exercise)) {
    ++other_exercises_[header.exercise];
    return countIgnored(tally, fmt::format("PDU of exercise {}", header.exercise));
  }
  exercise_ = header.exercise;
  if (!(std::abs(arrival_s - origin_s_) <= kMaxTime_s)) {
    return countBad(tally, fmt::format("PDU {}", tally.records),
                    fmt::format("it arrived {:.6g} s after the first one, more than {:.6g} s",
                                arrival_s - origin_s_, kMaxTime_s));
  }
  std::string fault;
  const auto timeOf = [&](const EntityId& id) {
    const double time_s = clocks_.timeOf(id, header, arrival_s) - origin_s_;
    last_s_ = std::max(last_s_, time_s);
    return time_s;
  };
  if (type == PduType::entity_state) {
    if (const auto state = decodeEntityState(bytes, header.length, fault))
      takeState(*state, timeOf(state->id));
  } else if (type == PduType::emission) {
    if (const auto emission = decodeEmission(bytes, header.length, fault))
      takeEmission(*emission, timeOf(emission->entity), header.version);
  } else if (const auto transmitter = decodeTransmitter(bytes, header.length, fault)) {
    takeTransmitter(*transmitter, timeOf(transmitter->entity));
  }
  if (!fault.empty()) countBad(tally, fmt::format("PDU {}", tally.records), fault);
}

DisRecorder::Entity& DisRecorder::entityOf(const EntityId& id) {
  const auto [found, is_new] = entities_.try_emplace(id.key());
  if (!is_new) return found->second;
  if (recording_.objects.size() >= RecordingLimits::kObjects) {
    throw Error(ErrorCode::bad_input,
                fmt::format("more than {} entities; a recording of one exercise has fewer",
                            RecordingLimits::kObjects));
  }
  found->second.object = recording_.objects.size();
  RecordedObject object;
  object.id = textOf(id);
  object.name = "entity " + object.id;
  recording_.objects.push_back(std::move(object));
  return found->second;
}

std::optional<PoseSample> poseSampleOf(const Vec3d& position_m, const BodyAxes& axes) {
  const GeodeticPosition position = fromEcef(position_m);
  PoseSample pose;
  pose.latitude_deg = position.latitude_deg;
  pose.longitude_deg = position.longitude_deg;
  pose.height_msl_m = position.height_ellipsoid_m - geoidUndulation_m(pose.latitude_deg, pose.longitude_deg);
  if (!(pose.height_msl_m >= PositionLimits::kLowest_m && pose.height_msl_m <= PositionLimits::kHighest_m))
    return std::nullopt;
  const LocalAttitude attitude = attitudeOf(axes, pose.latitude_deg, pose.longitude_deg);
  pose.heading_deg = attitude.heading_deg;
  pose.pitch_deg = attitude.pitch_deg;
  pose.roll_deg = attitude.roll_deg;
  return pose;
}

void DisRecorder::addPose(Entity& entity, const Vec3d& position_m, const BodyAxes& axes, double time_s) {
  auto pose = poseSampleOf(position_m, axes);
  if (!pose) return countIgnored(recording_.tally, "positions higher than 100 km or lower than -12 km");
  pose->t_s = time_s;
  auto& poses = recording_.objects[entity.object].poses;
  const std::size_t before = poses.size();
  interop::addPose(poses, *pose);
  if (poses.size() > before) countSample();
}

/// The path between two states as it was reckoned, turned so that it ends at the new state.
void DisRecorder::fillGap(const Entity& before, const EntityState& state, double time_s) {
  const double gap_s = time_s - before.time_s;
  if (gap_s < 0.2 || gap_s > options_.entity_timeout_s) return;
  const Vec3d correction = state.position_m - reckonedPose(before.state, gap_s).position_m;
  const Vec3d middle = reckonedPose(before.state, gap_s / 2).position_m + correction / 2.0;
  const double bow_m = length(middle - (before.state.position_m + state.position_m) / 2.0);
  if (!(length(correction) < kJump_m) || !(bow_m > kStraight_m)) return;
  // The bow of a curve falls with the square of the number of parts.
  const int parts = std::min(32, static_cast<int>(std::ceil(std::sqrt(bow_m / kStraight_m))) + 1);
  Entity entity = before;
  for (int i = 1; i < parts; ++i) {
    const double part = static_cast<double>(i) / parts;
    const ReckonedPose pose = reckonedPose(before.state, part * gap_s);
    addPose(entity, pose.position_m + correction * part, pose.axes, before.time_s + part * gap_s);
  }
}

void DisRecorder::takeState(const EntityState& state, double time_s) {
  Entity& entity = entityOf(state.id);
  RecordedObject& object = recording_.objects[entity.object];
  if (!entity.is_known) {
    const std::string marking = markingText(state.marking);
    if (!marking.empty()) object.name = marking;
    object.type = fmt::format("{}", fmt::join(state.type, "."));
    object.domain = domainOf(state.type);
    object.side = sideOf(state.force);
    object.keys.dis_entity_type = state.type;
  } else if (time_s < entity.time_s) {
    ++late_;
    return;  // the state after it is known
  } else {
    if (time_s - entity.time_s > options_.entity_timeout_s) {
      addPresence(object.presence, entity.time_s + options_.entity_timeout_s, false);
      addPresence(object.presence, time_s, true);
    }
    fillGap(entity, state, time_s);
  }
  addPresence(object.presence, time_s, !state.isDestroyed());
  addPose(entity, state.position_m, axesOf(state.orientation_rad), time_s);
  entity.state = state;
  entity.time_s = time_s;
  entity.is_known = true;
}

std::string DisRecorder::emitterText(int name) const {
  const auto found = options_.emitter_names.find(name);
  return found == options_.emitter_names.end() ? fmt::format("{}", name)
                                               : fmt::format("{} ({})", name, found->second);
}

DisRecorder::Beam& DisRecorder::beamOf(const EntityId& id, int system, int number) {
  const std::size_t object = entityOf(id).object;
  const auto [found, is_new] = systemOf(id, system).try_emplace(number);
  if (!is_new) return found->second;
  if (++beams_ > RecordingLimits::kObjects)
    throw Error(ErrorCode::bad_input, fmt::format("more than {} beams", RecordingLimits::kObjects));
  found->second.beam = recording_.beams.size();
  recording_.beams.emplace_back();
  recording_.beams.back().object = object;
  return found->second;
}

void DisRecorder::switchOff(Beam& beam, double time_s) {
  auto& states = recording_.beams[beam.beam].states;
  if (states.empty() || !states.back().is_on) return;
  BeamState state = states.back();
  state.t_s = std::max(time_s, state.t_s);
  state.is_on = false;
  addState(states, state);
  countSample();
}

void DisRecorder::setState(Beam& beam, const BeamState& state) {
  auto& states = recording_.beams[beam.beam].states;
  if (!states.empty() && state.t_s - beam.time_s > options_.emission_timeout_s)
    switchOff(beam, beam.time_s + options_.emission_timeout_s);
  const std::size_t before = states.size();
  addState(states, state);
  if (states.size() > before) countSample();
  beam.time_s = std::max(beam.time_s, state.t_s);
}

void DisRecorder::takeEmission(const Emission& emission, double time_s, int version) {
  entityOf(emission.entity);
  if (emission.systems.empty()) {  // the entity has ceased to emit
    for (auto& [number, system] : systems_[emission.entity.key()]) {
      for (auto& [beam_number, beam] : system) {
        if (number >= 0) switchOff(beam, time_s);
      }
    }
  }
  for (const EmissionSystem& system : emission.systems) {
    for (const EmissionBeam& told : system.beams) {
      Beam& beam = beamOf(emission.entity, system.number, told.number);
      RecordedBeam& record = recording_.beams[beam.beam];
      record.name = fmt::format("emitter {}, beam {}", emitterText(system.name), told.number);
      record.kind = kindOf(told.function);
      record.keys = {system.name, system.function, told.function, told.parameter_index, std::nullopt};
      if (std::isfinite(system.location_m.z))
        record.height_m = std::clamp(-system.location_m.z, -100.0, 100.0);
      BeamState state = stateOf(told, time_s);
      if (std::isfinite(told.erp_dbm) && told.erp_dbm > kMaxErp_dbm) {
        state.erp_dbm = ratioToDb(told.erp_dbm) + 30;
        ++watts_;
      } else if (told.erp_dbm != 0 && std::isfinite(told.erp_dbm)) {
        state.erp_dbm = told.erp_dbm;
      } else {
        ++no_power_;
      }
      // Of several targets the first one; search beams list what they have found.
      const bool is_held = told.function >= kTrack && told.function <= kJam;
      if (is_held && !told.targets.empty() && told.targets[0].entity != 0)
        state.target = entityOf(told.targets[0]).object;
      setState(beam, state);
    }
    // Up to version 6 a beam that its system does not list is off; in version 7 a system may be told in part.
    if (version > 6 && !system.beams.empty()) continue;
    auto& known_systems = systems_[emission.entity.key()];
    const auto known_system = known_systems.find(system.number);
    if (known_system == known_systems.end()) continue;
    for (auto& [number, beam] : known_system->second) {
      const bool is_listed = std::any_of(system.beams.begin(), system.beams.end(),
                                         [n = number](const EmissionBeam& b) { return b.number == n; });
      if (!is_listed) switchOff(beam, time_s);
    }
  }
}

void DisRecorder::takeTransmitter(const Transmitter& transmitter, double time_s) {
  Beam& beam = beamOf(transmitter.entity, -1 - transmitter.radio, 0);
  RecordedBeam& record = recording_.beams[beam.beam];
  record.name = fmt::format("radio {}", transmitter.radio);
  record.kind = BeamKind::transmitter;
  record.keys.dis_radio = transmitter.radio;
  if (std::isfinite(transmitter.relative_antenna_m.z))
    record.height_m = std::clamp(-transmitter.relative_antenna_m.z, -100.0, 100.0);
  BeamState state;
  state.t_s = time_s;
  state.is_on = transmitter.state == 2;
  state.frequency_hz = known(static_cast<double>(transmitter.frequency_hz));
  state.bandwidth_hz = known(transmitter.bandwidth_hz);
  if (std::isfinite(transmitter.power_dbm) && transmitter.power_dbm != 0)
    state.power_dbm = transmitter.power_dbm;
  setState(beam, state);
}

Recording DisRecorder::finish() {
  for (auto& [key, entity] : entities_) {
    if (entity.is_known && last_s_ - entity.time_s > options_.entity_timeout_s)
      addPresence(recording_.objects[entity.object].presence, entity.time_s + options_.entity_timeout_s,
                  false);
  }
  for (auto& [entity, systems] : systems_) {
    for (auto& [number, system] : systems) {
      for (auto& [beam_number, beam] : system) {
        if (last_s_ - beam.time_s > options_.emission_timeout_s)
          switchOff(beam, beam.time_s + options_.emission_timeout_s);
      }
    }
  }
  for (RecordedObject& object : recording_.objects) sortByTime(object);
  for (RecordedBeam& beam : recording_.beams) sortByTime(beam);
  auto& notes = recording_.tally.notes;
  if (late_ > 0)
    notes.push_back(fmt::format("{} Entity State PDUs came after a later one and were left out", late_));
  if (watts_ > 0) {
    notes.push_back(fmt::format("{} an effective radiated power above {} dBm; it is taken as watts",
                                countText(watts_, "beam has", "beams have"), kMaxErp_dbm));
  }
  if (no_power_ > 0)
    notes.push_back(fmt::format("{} no effective radiated power (0 dBm); it is that of the database",
                                countText(no_power_, "beam has", "beams have")));
  if (clocks_.untrusted() > 0) {
    notes.push_back(
        fmt::format("the timestamps of {} PDUs do not agree with their arrivals, which are used instead",
                    clocks_.untrusted()));
  }
  for (const auto& [exercise, count] : other_exercises_) {
    notes.push_back(
        fmt::format("{} of exercise {} are not used, only those of exercise {}: --exercise {} reads them",
                    countText(count, "PDU", "PDUs"), exercise, *exercise_, exercise));
  }
  const int low = lowest_version_, high = highest_version_;
  recording_.format =
      low == high ? fmt::format("DIS version {}", low) : fmt::format("DIS versions {} to {}", low, high);
  if (low > high) recording_.format = "DIS";
  return std::move(recording_);
}

}  // namespace emscape::interop::dis
