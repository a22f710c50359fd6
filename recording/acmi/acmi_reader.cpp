#include "recording/acmi/acmi_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_limits.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "recording/acmi/acmi_lines.h"
#include "recording/acmi/acmi_text.h"
#include "recording/acmi/carried_beams.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"

namespace emscape::interop {
namespace {

/// Frames of several threads are written out of order by some seconds.
constexpr double kMaxStepBack_s = 100;

/// @see the table "Object Types" of the documentation of ACMI 2.2
Domain domainOf(const std::string& type) {
  for (const char* tag : {"Navaid", "Misc", "Bullseye", "Waypoint", "Explosion", "Decoy", "Shrapnel",
                          "Projectile", "Container", "Parachutist"}) {
    if (hasAcmiTag(type, tag)) return Domain::scenery;
  }
  if (hasAcmiTag(type, "Weapon")) return Domain::weapon;
  if (hasAcmiTag(type, "Air")) return Domain::air;
  if (hasAcmiTag(type, "Ground")) return Domain::land;
  if (hasAcmiTag(type, "Submarine")) return Domain::subsurface;
  return hasAcmiTag(type, "Sea") ? Domain::sea : Domain::other;
}

std::string printable(std::string_view text) {
  return printableText(acmiValue(text));
}

/// Without the byte order mark.
std::string_view withoutMark(std::string_view line) {
  if (line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
  return line;
}

}  // namespace

void AcmiReader::takeHeader(std::string_view line, long long line_number) {
  line = withoutMark(line);
  if (line.empty()) return;
  ++header_lines_;
  if (header_lines_ == 1) {
    if (isSameName(line.substr(0, 9), "FileType=") &&
        line.find("text/acmi/tacview") != std::string_view::npos)
      return;
    throw Error(ErrorCode::bad_input, {"", static_cast<int>(line_number), 1},
                "an ACMI recording begins with FileType=text/acmi/tacview");
  }
  if (!isSameName(line.substr(0, 12), "FileVersion=") || line.substr(12, 2) != "2.") {
    throw Error(ErrorCode::bad_input, {"", static_cast<int>(line_number), 1},
                fmt::format("'{}' must be FileVersion=2.0 to FileVersion=2.2; open an older recording in "
                            "Tacview and save it again",
                            printable(line.substr(0, 40))));
  }
  recording_.format = "ACMI " + printable(line.substr(12, 8));
}

void AcmiReader::take(std::string_view line, long long line_number) {
  if (header_lines_ < 2) return takeHeader(line, line_number);
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  if (line.empty() || line.substr(0, 2) == "//") return;
  ++recording_.tally.records;
  const std::string location = fmt::format("line {}", line_number);
  bool removes = line.front() == '-';
  if (line.front() == '#') {
    const auto time_s = acmiFrame_s(line);
    line.remove_prefix(1);
    const auto id = line.size() > 1 && line.front() == '-' ? acmiId(line.substr(1)) : std::nullopt;
    // Some programs write #-1001 for -1001; a frame is not so long before the last one.
    removes = id && states_.count(*id) != 0 && (!time_s || *time_s < time_s_ - kMaxStepBack_s);
    if (!removes) {
      if (!time_s) {
        return countBad(
            recording_.tally, location,
            fmt::format("'#{}' is no time within {} s", printable(line.substr(0, 40)), kMaxAcmiFrame_s));
      }
      time_s_ = *time_s;
      return;
    }
  }
  if (removes) {
    std::string_view rest = line.substr(1);
    const auto id = acmiId(nextAcmiPart(rest));
    if (!id) return countBad(recording_.tally, location, "'-' must be followed by the id of an object");
    return remove(*id);
  }
  std::string_view rest = line;
  const std::string_view first = nextAcmiPart(rest);
  const auto id = acmiId(first);
  if (!id) {
    return countBad(recording_.tally, location,
                    fmt::format("'{}' is no hexadecimal id of an object", printable(first.substr(0, 40))));
  }
  if (*id == 0) {
    takeGlobal(rest);
  } else {
    takeObject(*id, rest, location);
  }
}

void AcmiReader::takeGlobal(std::string_view properties) {
  while (!properties.empty()) {
    const std::string_view part = nextAcmiPart(properties);
    const std::size_t at = part.find('=');
    if (at == std::string_view::npos) continue;
    const std::string_view name = part.substr(0, at), value = part.substr(at + 1);
    if (isSameName(name, "ReferenceLongitude") || isSameName(name, "ReferenceLatitude")) {
      const bool is_longitude = isSameName(name, "ReferenceLongitude");
      const auto number = numberIn(value);
      if (number && std::abs(*number) <= (is_longitude ? 360 : 90))
        (is_longitude ? reference_longitude_deg_ : reference_latitude_deg_) = *number;
    } else if (isSameName(name, "ReferenceTime")) {
      recording_.epoch_ms = parseUtc_ms(std::string(value));
      if (!recording_.epoch_ms && !value.empty()) {  // some programs omit the Z
        recording_.epoch_ms = parseUtc_ms(std::string(value) + "Z");
      }
    } else if (isSameName(name, "Event")) {
      takeEvent(std::string(value));
    }
  }
}

void AcmiReader::takeEvent(const std::string& event) {
  const std::size_t at = event.find('|');
  const std::string kind = event.substr(0, at);
  if ((kind == "Destroyed" || kind == "LeftArea") && at != std::string::npos) {
    const auto id = acmiId(std::string_view(event).substr(at + 1, event.find('|', at + 1) - at - 1));
    const auto found = id ? states_.find(*id) : states_.end();
    if (found != states_.end()) return addPresence(objectOf(found->second).presence, time_s_, false);
  }
  countIgnored(recording_.tally, "event " + printable(kind.substr(0, 40)));
}

void AcmiReader::remove(std::uint64_t id) {
  const auto found = states_.find(id);
  if (found == states_.end()) return;  // told twice, or of an object without a position
  addPresence(objectOf(found->second).presence, time_s_, false);
  states_.erase(found);  // ids are used again
}

AcmiReader::State& AcmiReader::stateOf(std::uint64_t id) {
  const auto [found, is_new] = states_.try_emplace(id);
  if (!is_new) return found->second;
  if (recording_.objects.size() >= RecordingLimits::kObjects) {
    throw Error(ErrorCode::bad_input,
                fmt::format("more than {} objects; cut the recording into parts", RecordingLimits::kObjects));
  }
  found->second.object = recording_.objects.size();
  RecordedObject object;
  object.id = fmt::format("{:x}", id);
  recording_.objects.push_back(std::move(object));
  return found->second;
}

void AcmiReader::takeObject(std::uint64_t id, std::string_view properties, const std::string& location) {
  State& state = stateOf(id);
  while (!properties.empty()) {
    const std::string_view part = nextAcmiPart(properties);
    const std::size_t at = part.find('=');
    if (at == std::string_view::npos) {
      if (!part.empty())
        countBad(recording_.tally, location,
                 fmt::format("'{}' is no PROPERTY=VALUE", printable(part.substr(0, 40))));
      continue;
    }
    takeProperty(state, part.substr(0, at), part.substr(at + 1), location);
  }
  if (!state.beam) return;
  state.radar.t_s = time_s_;
  if (!state.has_mode) state.radar.is_on = true;
  const auto target = state.is_locked && state.locked ? states_.find(*state.locked) : states_.end();
  state.radar.target = target == states_.end() ? kNoTarget : target->second.object;
  auto& states = recording_.beams[*state.beam].states;
  const std::size_t before = states.size();
  addState(states, state.radar);
  samples_ += states.size() - before;
}

void AcmiReader::takeProperty(State& state, std::string_view name, std::string_view value,
                              const std::string& location) {
  RecordedObject& object = objectOf(state);
  if (isSameName(name, "T")) {
    place(state, value, location);
  } else if (isSameName(name, "Type")) {
    object.type = printable(value);
    for (std::size_t at = 0; (at = object.type.find('+', at)) != std::string::npos;
         ++at) {  // "Air + FixedWing"
      while (at > 0 && object.type[at - 1] == ' ') object.type.erase(--at, 1);
      while (at + 1 < object.type.size() && object.type[at + 1] == ' ') object.type.erase(at + 1, 1);
    }
    object.keys.acmi_type = object.type;
    object.domain = domainOf(object.type);
    if (isAcmiBeam(object.type)) takeRadarProperty(state, "RadarMode", "1");
  } else if (isSameName(name, "Name")) {
    if (!object.keys.acmi_name.empty()) return;
    object.keys.acmi_name = printable(value);
    object.name = object.keys.acmi_name + object.name;  // a pilot told before
  } else if (isSameName(name, "Pilot") || isSameName(name, "CallSign")) {
    const std::string told = printable(value);
    if (!told.empty() && object.name == object.keys.acmi_name && told != object.name)
      object.name += " " + told;
  } else if (isSameName(name, "Color") || isSameName(name, "Coalition")) {
    (isSameName(name, "Color") ? state.color : state.coalition) = printable(value);
    object.side = acmiSide(state.color, state.coalition);
  } else if (isSameName(name, "Parent")) {
    if (const auto parent = acmiId(value)) parents_[state.object] = fmt::format("{:x}", *parent);
  } else if (isSameName(name, "Visible") || isSameName(name, "Disabled")) {
    const auto number = numberIn(value);
    if (number) addPresence(object.presence, time_s_, (*number != 0) == (isSameName(name, "Visible")));
  } else if (isSameName(name, "LockedTarget")) {
    state.locked = acmiId(value);
  } else if (isSameName(name, "LockedTargetMode")) {
    state.is_locked = numberIn(value).value_or(0) != 0;
  } else if (!takeRadarProperty(state, name, value)) {
    countIgnored(recording_.tally, "property " + printable(name.substr(0, 40)));
  }
}

bool AcmiReader::takeRadarProperty(State& state, std::string_view name, std::string_view value) {
  if (!isSameName(name.substr(0, 5), "Radar")) return false;
  double* angle = nullptr;
  if (isSameName(name, "RadarAzimuth")) angle = &state.radar.azimuth_deg;
  if (isSameName(name, "RadarElevation")) angle = &state.radar.elevation_deg;
  if (isSameName(name, "RadarHorizontalBeamwidth")) angle = &state.radar.beamwidth_az_deg;
  if (isSameName(name, "RadarVerticalBeamwidth")) angle = &state.radar.beamwidth_el_deg;
  if (angle == nullptr && !isSameName(name, "RadarMode"))
    return isSameName(name, "RadarRange") || isSameName(name, "RadarRoll");
  const auto number = numberIn(value);
  if (!number || std::abs(*number) > 360) return true;
  if (angle != nullptr) {
    *angle = *number;
  } else {
    state.radar.is_on = *number != 0;
    state.has_mode = true;
  }
  if (!state.beam) {
    state.beam = recording_.beams.size();
    RecordedBeam beam;
    beam.object = state.object;
    beam.name = "radar";
    beam.kind = BeamKind::radar;
    recording_.beams.push_back(std::move(beam));
  }
  return true;
}

void AcmiReader::place(State& state, std::string_view value, const std::string& location) {
  const auto told = acmiPlace(value);
  if (!told) {
    return countBad(recording_.tally, location,
                    fmt::format("T={} does not have 3, 5, 6 or 9 numbers separated by |",
                                printable(value.substr(0, 60))));
  }
  double* const parts[] = {&state.longitude_deg, &state.latitude_deg, &state.altitude_m,
                           &state.roll_deg,      &state.pitch_deg,    &state.yaw_deg};
  bool is_any = false;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!told->values[i]) continue;
    *parts[i] = *told->values[i];
    is_any = true;
  }
  if (!is_any) return;
  const bool is_sound = std::abs(state.longitude_deg) <= 720 && std::abs(state.latitude_deg) <= 180 &&
                        state.altitude_m >= PositionLimits::kLowest_m &&
                        state.altitude_m <= PositionLimits::kHighest_m;
  if (!is_sound) {
    return countBad(
        recording_.tally, location,
        fmt::format("T={} is no position from {} to {} m above mean sea level",
                    printable(value.substr(0, 60)), PositionLimits::kLowest_m, PositionLimits::kHighest_m));
  }
  PoseSample pose;
  pose.t_s = time_s_;
  pose.longitude_deg = state.longitude_deg;
  pose.latitude_deg = state.latitude_deg;
  pose.height_msl_m = state.altitude_m;
  if (!std::isnan(state.yaw_deg)) {
    pose.heading_deg = state.yaw_deg;
    pose.pitch_deg = std::isnan(state.pitch_deg) ? 0 : std::clamp(state.pitch_deg, -90.0, 90.0);
    pose.roll_deg = std::isnan(state.roll_deg) ? 0 : state.roll_deg;
  }
  auto& poses = objectOf(state).poses;
  const std::size_t before = poses.size();
  addPose(poses, pose);
  samples_ += poses.size() - before;
  if (samples_ > RecordingLimits::kSamples) {
    throw Error(ErrorCode::bad_input, fmt::format("more than {} positions; cut the recording into parts",
                                                  RecordingLimits::kSamples));
  }
}

std::optional<PoseSample> AcmiReader::placed(PoseSample pose) const {
  pose.latitude_deg += reference_latitude_deg_;
  pose.longitude_deg = wrapLongitude_deg(pose.longitude_deg + reference_longitude_deg_);
  if (std::abs(pose.latitude_deg) > PositionLimits::kLatitude_deg) return std::nullopt;
  return pose;
}

void AcmiReader::dropPosesOutside(RecordedObject& object) {
  auto& poses = object.poses;
  const auto sound =
      std::remove_if(poses.begin(), poses.end(), [this](const PoseSample& pose) { return !placed(pose); });
  for (auto pose = sound; pose != poses.end(); ++pose)
    countBad(recording_.tally, "object " + object.id,
             "a latitude with ReferenceLatitude is outside -90 to 90 deg");
  poses.erase(sound, poses.end());
}

std::vector<std::pair<std::uint64_t, PoseSample>> AcmiReader::latestPoses() const {
  std::vector<std::pair<std::uint64_t, PoseSample>> latest;
  for (const auto& [id, state] : states_) {
    const auto& poses = recording_.objects[state.object].poses;
    if (poses.empty()) continue;
    if (const auto pose = placed(poses.back())) latest.emplace_back(id, *pose);
  }
  std::sort(latest.begin(), latest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return latest;
}

std::size_t AcmiReader::keepLatest(std::size_t max_objects) {
  std::vector<std::pair<double, std::uint64_t>> by_time;
  for (const auto& [id, state] : states_) {
    const auto& poses = objectOf(state).poses;
    by_time.emplace_back(poses.empty() ? -1e9 : poses.back().t_s, id);
  }
  const std::size_t dropped = by_time.size() > max_objects ? by_time.size() - max_objects : 0;
  std::sort(by_time.begin(), by_time.end());
  for (std::size_t i = 0; i < dropped; ++i) states_.erase(by_time[i].second);
  std::vector<std::size_t> kept_as(recording_.objects.size(), kNoTarget);
  std::vector<RecordedObject> objects;
  std::vector<RecordedBeam> beams;
  std::vector<State*> kept;
  for (auto& [id, state] : states_) kept.push_back(&state);
  std::sort(kept.begin(), kept.end(), [](const State* a, const State* b) { return a->object < b->object; });
  for (State* const state : kept) {
    kept_as[state->object] = objects.size();
    RecordedObject& object = objects.emplace_back(std::move(objectOf(*state)));
    dropPosesOutside(object);
    if (object.poses.size() > 1) object.poses = {object.poses.back()};
    if (object.presence.size() > 1) object.presence = {object.presence.back()};
    if (!state->beam) continue;
    RecordedBeam& beam = beams.emplace_back(std::move(recording_.beams[*state->beam]));
    if (beam.states.size() > 1) beam.states = {beam.states.back()};
    state->beam = beams.size() - 1;
  }
  const auto keep = [&kept_as](std::size_t& index) {
    if (index != kNoTarget) index = kept_as[index];
  };
  for (auto& [id, state] : states_) {
    keep(state.object);
    keep(state.radar.target);
  }
  for (RecordedBeam& beam : beams) {
    keep(beam.object);
    for (BeamState& state : beam.states) keep(state.target);
  }
  std::unordered_map<std::size_t, std::string> parents;
  for (auto& [index, parent] : parents_) {
    if (kept_as[index] != kNoTarget) parents[kept_as[index]] = std::move(parent);
  }
  parents_ = std::move(parents);
  recording_.objects = std::move(objects);
  recording_.beams = std::move(beams);
  samples_ = recording_.objects.size() + recording_.beams.size();
  return dropped;
}

Recording AcmiReader::finish() {
  for (RecordedObject& object : recording_.objects) {
    dropPosesOutside(object);
    for (PoseSample& pose : object.poses) pose = *placed(pose);
    sortByTime(object);
  }
  for (RecordedBeam& beam : recording_.beams) sortByTime(beam);
  joinCarriedBeams(recording_, parents_);
  for (RecordedObject& object : recording_.objects) {
    if (object.name.empty()) object.name = object.type.empty() ? "object " + object.id : object.type;
  }
  return std::move(recording_);
}

Recording readAcmi(ByteSource& source, const std::string& name, const ProgressSink& progress) {
  AcmiReader reader;
  LineReader lines(source);
  AcmiLines logical_lines;
  double reported = 0;
  try {
    for (std::string_view line; lines.next(line);) {
      if (progress && source.fraction() >= reported) {
        progress("reading " + name, source.fraction());
        reported = source.fraction() + 0.01;
      }
      if (!lines.isTerminated()) {  // an object's line may lack digits that were to follow
        reader.tally().torn = fmt::format(
            "line {} has no end: the recording was cut there, and the line is not used", lines.line());
        break;
      }
      const long long too_long = logical_lines.tooLong();
      if (const auto logical = logical_lines.take(line, lines.isCut())) {
        reader.take(*logical, logical_lines.line());
      } else if (logical_lines.tooLong() != too_long) {
        countBad(reader.tally(), fmt::format("line {}", logical_lines.line()), kTooLongAcmiLine);
      }
    }
  } catch (const Error& error) {
    throw Error(error.code(), {name, error.location().line, error.location().column}, error.message());
  }
  if (!source.failure().empty())
    reader.tally().torn = fmt::format("after line {}: {}", lines.line(), source.failure());
  Recording recording = reader.finish();
  if (recording.format.empty())
    throw Error(ErrorCode::bad_input, {name, 1, 1},
                "an ACMI recording begins with FileType=text/acmi/tacview");
  return recording;
}

}  // namespace emscape::interop
