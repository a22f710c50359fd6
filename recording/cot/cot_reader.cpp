#include "recording/cot/cot_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/count_text.h"
#include "recording/beams/directions.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/xml.h"

namespace emscape::interop {
namespace {

constexpr double kUnknownHeight_m = 9999999;
constexpr std::string_view kEventBegin = "<event", kEventEnd = "</event>";

std::optional<double> attributeOf(const pugi::xml_node& node, const char* attribute) {
  return numberIn(node.attribute(attribute).value());
}

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

struct CotReader::Event {
  pugi::xml_document document;
  pugi::xml_node detail;
  std::string uid, type, location;
  double time_s = 0, stale_s = 0;
  PoseSample pose;
};

bool isCot(std::string_view head) {
  return head.find(kEventBegin) != std::string_view::npos && head.find("uid=") != std::string_view::npos;
}

bool CotSplitter::isWithin() const {
  const std::size_t begin = text_.rfind(kEventBegin);
  return begin != std::string::npos && text_.compare(begin, kEventBegin.size() + 1, "<events") != 0;
}

void CotSplitter::take(std::string_view bytes, const std::function<void(std::string_view)>& sink) {
  text_ += bytes;
  for (;;) {
    const std::size_t end = text_.find(kEventEnd, searched_);
    if (end == std::string::npos) break;
    const std::size_t begin = text_.rfind(kEventBegin, end);  // a list <events> may be around all
    if (begin != std::string::npos)
      sink(std::string_view(text_).substr(begin, end + kEventEnd.size() - begin));
    text_.erase(0, end + kEventEnd.size());
    searched_ = 0;
  }
  searched_ = text_.size() > kEventEnd.size() ? text_.size() - kEventEnd.size() : 0;
  if (text_.size() <= kLongest) return;
  text_.clear();
  searched_ = 0;
  ++dropped_;
}

CotReader::CotReader(const ReadOptions& options) : recorder_("Cursor on Target", options) {
  recorder_.hasUtc();
}

CotReader::Object& CotReader::objectOf(const std::string& uid) {
  const auto [found, is_new] = objects_.try_emplace(uid);
  if (is_new) found->second.index = recorder_.objectOf(uid);
  return found->second;
}

void CotReader::takeEvent(std::string_view xml) {
  Event event;
  event.location = fmt::format("event {}", ++tally().records);
  if (const std::string fault = parseXml(xml, event.document); !fault.empty())
    return countBad(tally(), event.location, fault);
  const pugi::xml_node node = childOf(event.document, "event");
  const pugi::xml_node point = childOf(node, "point");
  event.detail = childOf(node, "detail");
  event.uid = printableText(node.attribute("uid").value());
  event.type = printableText(node.attribute("type").value());
  const auto time_s = utcSeconds(node.attribute("time").value()),
             start_s = utcSeconds(node.attribute("start").value()),
             stale_s = utcSeconds(node.attribute("stale").value());
  const auto latitude_deg = attributeOf(point, "lat"), longitude_deg = attributeOf(point, "lon");
  if (event.uid.empty() || event.type.empty() || !time_s || !stale_s || !latitude_deg || !longitude_deg) {
    return countBad(tally(), event.location,
                    "an event has uid, type, time, stale (UTC), and a point with lat and lon");
  }
  event.time_s = *time_s;
  event.stale_s = *stale_s;
  last_s_ = std::max(last_s_, event.time_s);
  if (event.type.rfind("t-x-d-d", 0) == 0) {
    return remove(printableText(childOf(event.detail, "link").attribute("uid").value()), event.time_s);
  }
  if (*stale_s < start_s.value_or(*time_s)) return remove(event.uid, event.time_s);
  const pugi::xml_node sensor = childOf(event.detail, "sensor");
  std::string carrier;
  for (const pugi::xml_node& link : event.detail.children()) {
    if (nameOf(link) == "link" && std::string_view(link.attribute("relation").value()) == "p-p")
      carrier = printableText(link.attribute("uid").value());
  }
  const bool is_object = event.type.rfind("a-", 0) == 0;
  if (!is_object && !sensor)
    return countIgnored(tally(), "event of type " + printableText(event.type.substr(0, 40)));
  event.pose.t_s = event.time_s;
  event.pose.latitude_deg = *latitude_deg;
  event.pose.longitude_deg = *longitude_deg;
  const double height_m = attributeOf(point, "hae").value_or(kUnknownHeight_m);
  const bool has_height = height_m < kUnknownHeight_m;
  if (!has_height) ++without_height_;
  const bool is_sound = std::abs(*latitude_deg) <= 90 && std::abs(*longitude_deg) <= 720;
  event.pose.height_msl_m = has_height && is_sound ? heightMsl_m(*latitude_deg, *longitude_deg, height_m) : 0;
  // A sensor with a carrier has no position of its own.
  if (is_object || carrier.empty()) takeObject(event);
  if (sensor) takeSensor(event, carrier.empty() || is_object ? event.uid : carrier);
}

void CotReader::takeObject(Event& event) {
  Object& object = objectOf(event.uid);
  RecordedObject& record = recorder_.object(object.index);
  record.type = record.keys.cot_type = event.type;
  record.domain = domainOfCot(event.type);
  record.side = sideOfCot(event.type);
  const std::string callsign = printableText(childOf(event.detail, "contact").attribute("callsign").value());
  if (!callsign.empty()) record.name = callsign;
  const pugi::xml_node attitude = childOf(childOf(event.detail, "spatial"), "attitude");
  auto heading_deg = attributeOf(attitude, "yaw");
  if (!heading_deg) heading_deg = attributeOf(childOf(event.detail, "track"), "course");
  if (heading_deg) {
    event.pose.heading_deg = *heading_deg;
    event.pose.pitch_deg = attributeOf(attitude, "pitch").value_or(kUnknown);
    event.pose.roll_deg = attributeOf(attitude, "roll").value_or(kUnknown);
  }
  if (object.is_present && event.time_s > object.stale_s) addPresence(record.presence, object.stale_s, false);
  addPresence(record.presence, event.time_s, true);
  object.is_present = true;
  object.stale_s = event.stale_s;
  recorder_.add(object.index, event.pose, event.location);
}

void CotReader::takeSensor(const Event& event, const std::string& carrier) {
  const std::size_t object = objectOf(carrier).index;
  const auto [found, is_new] = sensors_.try_emplace(event.uid);
  Sensor& sensor = found->second;
  const pugi::xml_node node = childOf(event.detail, "sensor");
  if (is_new) {
    sensor.beam = recorder_.addBeam(object);
    RecordedBeam& beam = recorder_.beam(sensor.beam);
    beam.name = printableText(node.attribute("model").value());
    if (beam.name.empty())
      beam.name = printableText(childOf(event.detail, "contact").attribute("callsign").value());
    if (beam.name.empty()) beam.name = "sensor";
    beam.kind = BeamKind::radar;
  } else if (event.time_s > sensor.stale_s) {
    switchOff(sensor, sensor.stale_s);
  }
  BeamState state;
  state.t_s = event.time_s;
  state.is_on = true;
  const auto azimuth_deg = attributeOf(node, "azimuth"), elevation_deg = attributeOf(node, "elevation"),
             width_deg = attributeOf(node, "fov"), height_deg = attributeOf(node, "vfov");
  if (azimuth_deg && std::abs(*azimuth_deg) <= 720) {
    state.azimuth_deg = *azimuth_deg;
    state.elevation_deg = std::clamp(elevation_deg.value_or(0), -90.0, 90.0);
  }
  if (width_deg && *width_deg > 0 && *width_deg <= 360) state.beamwidth_az_deg = *width_deg;
  if (height_deg && *height_deg > 0 && *height_deg <= 360) state.beamwidth_el_deg = *height_deg;
  recorder_.countSample();
  addState(recorder_.beam(sensor.beam).states, state);
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
  if (without_height_ > 0) {
    tally().notes.push_back(fmt::format("{} no height (hae 9999999); 0 m above mean sea level is taken",
                                        countText(without_height_, "event has", "events have")));
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
