#include "recording/cot/cot_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text/count_text.h"
#include "recording/beams/directions.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"

namespace emscape::interop {
namespace {

/// The parts of a type "a-f-G-E-S".
char partOf(const std::string& type, std::size_t index) {
  return type.size() > 2 * index ? type[2 * index] : ' ';
}

/// Affiliations of MIL-STD-2525: assumed friends and suspects are what they are taken for.
Side sideOfCot(const std::string& type) {
  switch (partOf(type, 1)) {
    case 'f':
    case 'a':
      return Side::friendly;
    case 'h':
    case 's':
    case 'j':
    case 'k':
      return Side::hostile;
    case 'n':
      return Side::neutral;
    default:
      return Side::unknown;
  }
}

Domain domainOfCot(const std::string& type) {
  switch (partOf(type, 2)) {
    case 'A':
      return Domain::air;
    case 'G':
      return Domain::land;
    case 'S':
      return Domain::sea;
    case 'U':
      return Domain::subsurface;
    case 'P':
      return Domain::space;
    default:
      return Domain::other;
  }
}

}  // namespace

CotReader::CotReader(const ReadOptions& options) : recorder_("Cursor on Target", options) {
  recorder_.hasUtc();
}

CotReader::Object& CotReader::objectOf(const std::string& uid) {
  const auto [found, is_new] = objects_.try_emplace(uid);
  if (is_new) found->second.index = recorder_.objectOf(uid);
  return found->second;
}

void CotReader::takeEvent(std::string_view xml) {
  const std::string location = fmt::format("event {}", ++tally().records);
  std::string fault;
  const auto event = parseCotEvent(xml, fault);
  if (!event) return countBad(tally(), location, fault);
  take(*event, location);
}

void CotReader::take(const CotEvent& event, const std::string& location) {
  last_s_ = std::max(last_s_, event.time_s);
  if (!event.removed.empty()) return remove(event.removed, event.time_s);
  if (!event.isUsed())
    return countIgnored(tally(), "event of type " + printableText(event.type.substr(0, 40)));
  if (event.hasPlace()) takeObject(event, location);
  if (event.has_sensor) takeSensor(event);
}

void CotReader::takeObject(const CotEvent& event, const std::string& location) {
  Object& object = objectOf(event.uid);
  RecordedObject& record = recorder_.object(object.index);
  record.type = record.keys.cot_type = event.type;
  record.domain = domainOfCot(event.type);
  record.side = sideOfCot(event.type);
  if (!event.callsign.empty()) record.name = event.callsign;
  if (object.is_present && event.time_s > object.stale_s) addPresence(record.presence, object.stale_s, false);
  addPresence(record.presence, event.time_s, true);
  object.is_present = true;
  object.stale_s = event.stale_s;
  PoseSample pose = event.pose;
  if (!event.has_height) pose.height_msl_m = kUnknown;
  recorder_.add(object.index, pose, location);
}

void CotReader::takeSensor(const CotEvent& event) {
  const std::size_t object = objectOf(event.sensorCarrier()).index;
  const auto [found, is_new] = sensors_.try_emplace(event.uid);
  Sensor& sensor = found->second;
  if (is_new) {
    sensor.beam = recorder_.addBeam(object);
    RecordedBeam& beam = recorder_.beam(sensor.beam);
    beam.name = !event.sensor_name.empty() ? event.sensor_name
                : !event.callsign.empty()  ? event.callsign
                                           : "sensor";
    beam.kind = BeamKind::radar;
  } else if (event.time_s > sensor.stale_s) {
    switchOff(sensor, sensor.stale_s);
  }
  recorder_.countSample();
  addState(recorder_.beam(sensor.beam).states, event.sensor);
  sensor.stale_s = event.stale_s;
}

void CotReader::switchOff(const Sensor& sensor, double time_s) {
  auto& states = recorder_.beam(sensor.beam).states;
  if (states.empty() || !states.back().is_on) return;
  BeamState state = states.back();
  state.t_s = std::max(time_s, state.t_s);
  state.is_on = false;
  addState(states, state);
}

void CotReader::remove(const std::string& uid, double time_s) {
  const auto object = objects_.find(uid);
  if (object != objects_.end() && object->second.is_present) {
    addPresence(recorder_.object(object->second.index).presence, time_s, false);
    object->second.is_present = false;
  }
  const auto sensor = sensors_.find(uid);
  if (sensor != sensors_.end()) switchOff(sensor->second, time_s);
}

Recording CotReader::finish() {
  for (const auto& [uid, object] : objects_) {
    if (object.is_present && object.stale_s < last_s_)
      addPresence(recorder_.object(object.index).presence, object.stale_s, false);
  }
  for (const auto& [uid, sensor] : sensors_) {
    if (sensor.stale_s < last_s_) switchOff(sensor, sensor.stale_s);
  }
  Recording recording = recorder_.finish();
  turnIntoCarriers(recording, std::vector<bool>(recording.beams.size(), true));
  return recording;
}

Recording readCot(ByteSource& source, const ReadOptions& options) {
  CotReader reader(options);
  CotSplitter splitter;
  std::array<char, 65536> piece{};
  while (const std::size_t count = source.read(piece.data(), piece.size()))
    splitter.take({piece.data(), count}, [&](std::string_view event) { reader.takeEvent(event); });
  for (long long i = 0; i < splitter.dropped(); ++i)
    countBad(reader.tally(), "an event", "longer than 1 MiB");
  if (splitter.isWithin()) reader.tally().torn = "the last event has no </event>: it is not used";
  return reader.finish();
}

}  // namespace emscape::interop
