#include "recording/cot/cot_event.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "recording/common/dates.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/common/xml.h"

namespace emscape::interop {
namespace {

constexpr double kUnknownHeight_m = 9999999;
constexpr std::string_view kEventBegin = "<event", kEventEnd = "</event>";

std::optional<double> attributeOf(const pugi::xml_node& node, const char* attribute) {
  return numberIn(node.attribute(attribute).value());
}

/// Position and attitude of an event; false: it has no position.
bool takePlace(const pugi::xml_node& node, const pugi::xml_node& detail, CotEvent& event) {
  const pugi::xml_node point = childOf(node, "point");
  const auto latitude_deg = attributeOf(point, "lat"), longitude_deg = attributeOf(point, "lon");
  if (!latitude_deg || !longitude_deg) return false;
  event.pose.t_s = event.time_s;
  event.pose.latitude_deg = *latitude_deg;
  event.pose.longitude_deg = *longitude_deg;
  const double height_m = attributeOf(point, "hae").value_or(kUnknownHeight_m);
  event.has_height = height_m < kUnknownHeight_m;
  const bool is_sound = std::abs(*latitude_deg) <= 90 && std::abs(*longitude_deg) <= 720;
  event.pose.height_msl_m =
      event.has_height && is_sound ? heightMsl_m(*latitude_deg, *longitude_deg, height_m) : 0;
  const pugi::xml_node attitude = childOf(childOf(detail, "spatial"), "attitude");
  auto heading_deg = attributeOf(attitude, "yaw");
  if (!heading_deg) heading_deg = attributeOf(childOf(detail, "track"), "course");
  if (heading_deg) {
    event.pose.heading_deg = *heading_deg;
    event.pose.pitch_deg = attributeOf(attitude, "pitch").value_or(kUnknown);
    event.pose.roll_deg = attributeOf(attitude, "roll").value_or(kUnknown);
  }
  return true;
}

void takeSensor(const pugi::xml_node& node, CotEvent& event) {
  event.has_sensor = true;
  event.sensor_name = printableText(node.attribute("model").value());
  BeamState& state = event.sensor;
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
}

}  // namespace

std::optional<CotEvent> parseCotEvent(std::string_view xml, std::string& fault) {
  pugi::xml_document document;
  fault = parseXml(xml, document);
  if (!fault.empty()) return std::nullopt;
  const pugi::xml_node node = childOf(document, "event"), detail = childOf(node, "detail");
  CotEvent event;
  event.uid = printableText(node.attribute("uid").value());
  event.type = printableText(node.attribute("type").value());
  const auto time_s = utcSeconds(node.attribute("time").value()),
             start_s = utcSeconds(node.attribute("start").value()),
             stale_s = utcSeconds(node.attribute("stale").value());
  event.time_s = time_s.value_or(0);
  event.stale_s = stale_s.value_or(0);
  if (event.uid.empty() || event.type.empty() || !time_s || !stale_s || !takePlace(node, detail, event)) {
    fault = "an event has uid, type, time, stale (UTC), and a point with lat and lon";
    return std::nullopt;
  }
  event.callsign = printableText(childOf(detail, "contact").attribute("callsign").value());
  if (event.type.rfind("t-x-d-d", 0) == 0) {
    event.removed = printableText(childOf(detail, "link").attribute("uid").value());
    return event;
  }
  if (*stale_s < start_s.value_or(*time_s)) {
    event.removed = event.uid;
    return event;
  }
  for (const pugi::xml_node& link : detail.children()) {
    if (nameOf(link) == "link" && std::string_view(link.attribute("relation").value()) == "p-p")
      event.carrier = printableText(link.attribute("uid").value());
  }
  event.is_object = event.type.rfind("a-", 0) == 0;
  if (const pugi::xml_node sensor = childOf(detail, "sensor")) takeSensor(sensor, event);
  return event;
}

std::string restampedCotEvent(std::string_view xml, double time_s, double life_s) {
  pugi::xml_document document;
  if (!parseXml(xml, document).empty()) return std::string(xml);
  pugi::xml_node event = childOf(document, "event");
  const std::string time = utcTextOf(time_s), stale = utcTextOf(time_s + life_s);
  event.attribute("time").set_value(time.c_str());
  event.attribute("start").set_value(time.c_str());
  event.attribute("stale").set_value(stale.c_str());
  std::ostringstream text;
  document.save(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str();
}

std::string cotPing(const std::string& uid, double time_s) {
  return fmt::format(
      "<event version=\"2.0\" uid=\"{}\" type=\"t-x-c-t\" time=\"{}\" start=\"{}\" stale=\"{}\" how=\"m-g\">"
      "<point lat=\"0\" lon=\"0\" hae=\"0\" ce=\"9999999\" le=\"9999999\"/></event>\n",
      uid, utcTextOf(time_s), utcTextOf(time_s), utcTextOf(time_s + 20));
}

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

}  // namespace emscape::interop
