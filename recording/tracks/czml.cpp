#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files/json_reading.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "recording/common/dates.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/tracks/interpolated_track.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxCzmlBytes = std::size_t{64} << 20;

std::string textIn(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

constexpr double kEver_s = 1e15;

/// The begin or end of an interval; the first and the last year stand for no limit.
std::optional<double> limitOf(std::string_view text) {
  if (text.substr(0, 5) == "0000-") return -kEver_s;
  if (text.substr(0, 5) == "9999-") return kEver_s;
  return utcSeconds(text);
}

/// Time intervals "BEGIN/END" of a text or of a list of them.
/// @param faults  number of those that cannot be read
std::vector<std::pair<double, double>> intervalsOf(const Json& json, int& faults) {
  std::vector<std::pair<double, double>> intervals;
  const auto add = [&](const Json& item) {
    const std::string text = item.is_string() ? item.get<std::string>() : std::string();
    const std::size_t at = std::min(text.find('/'), text.size());
    const auto begin_s = limitOf(std::string_view(text).substr(0, at)),
               end_s = limitOf(std::string_view(text).substr(std::min(at + 1, text.size())));
    if (begin_s && end_s && *begin_s < *end_s) {
      intervals.emplace_back(*begin_s, *end_s);
    } else {
      ++faults;
    }
  };
  if (json.is_array()) {
    for (const Json& item : json) add(item);
  } else {
    add(json);
  }
  std::sort(intervals.begin(), intervals.end());
  return intervals;
}

class CzmlReader {
 public:
  explicit CzmlReader(const ReadOptions& options) : recorder_("CZML", options) { recorder_.hasUtc(); }

  Recording read(const Json& packets) {
    for (const Json& packet : packets) {
      ++recorder_.tally().records;
      location_ = fmt::format("packet {}", recorder_.tally().records);
      if (packet.is_object()) {
        takePacket(packet);
      } else {
        countBad(recorder_.tally(), location_, "it is no object");
      }
    }
    return recorder_.finish();
  }

 private:
  void takePacket(const Json& packet) {
    const std::string id = textIn(packet, "id");
    if (id == "document") return takeClock(packet);
    for (const auto& [key, value] : packet.items()) {
      if (key.rfind("agi_", 0) == 0) countIgnored(recorder_.tally(), printableText(key));
    }
    const auto position = packet.find("position");
    if (position == packet.end()) return countIgnored(recorder_.tally(), "packet without a position");
    if (position->is_array()) {
      for (const Json& part : *position) takePosition(packet, id, part);
    } else {
      takePosition(packet, id, *position);
    }
  }

  void takeClock(const Json& packet) {
    const auto clock = packet.find("clock");
    if (clock == packet.end() || !clock->is_object()) return;
    const auto interval = clock->find("interval");
    if (interval == clock->end()) return;
    int faults = 0;
    const auto intervals = intervalsOf(*interval, faults);
    if (faults > 0)
      countBad(recorder_.tally(), location_, "its clock's interval is not BEGIN/END in ISO 8601");
    if (!intervals.empty() && intervals.front().first > -kEver_s) begin_s_ = intervals.front().first;
  }

  void takePosition(const Json& packet, const std::string& id, const Json& position) {
    if (!position.is_object()) return countBad(recorder_.tally(), location_, "its position is no object");
    if (position.contains("reference")) return countIgnored(recorder_.tally(), "position of another object");
    const std::string frame = textIn(position, "referenceFrame");
    if (!frame.empty() && frame != "FIXED") {
      return countIgnored(recorder_.tally(), "position in the reference frame " + printableText(frame) +
                                                 " (only FIXED is read)");
    }
    const auto found = std::find_if(std::begin(kForms), std::end(kForms),
                                    [&](const char* form) { return position.contains(form); });
    if (found == std::end(kForms)) {
      return countIgnored(recorder_.tally(),
                          "position without cartographicDegrees, cartographicRadians or cartesian");
    }
    const std::string form = *found;
    std::vector<double> values;
    for (const Json& value : position[form]) {
      if (!value.is_number()) {
        // A time of ISO 8601 may stand where seconds from the epoch do.
        const auto time_s = value.is_string() && values.size() % 4 == 0
                                ? utcSeconds(value.get_ref<const std::string&>())
                                : std::nullopt;
        if (!time_s)
          return countBad(recorder_.tally(), location_, "its " + form + " has a value that is no number");
        values.push_back(*time_s - epochOf(position));
      } else {
        values.push_back(value.get<double>());
      }
    }
    const bool is_constant = values.size() == 3;
    if (!is_constant && (values.size() < 4 || values.size() % 4 != 0)) {
      return countBad(
          recorder_.tally(), location_,
          fmt::format("its {} has {} numbers: neither 3 nor a multiple of 4", form, values.size()));
    }
    const std::size_t object = recorder_.objectOf(id.empty() ? location_ : id);
    if (is_constant) {
      recorder_.addFixed(object, poseOf(form, 0, values.data()), location_);
    } else {
      takeSamples(position, form, values, object);
    }
    describe(packet, object);
  }

  void takeSamples(const Json& position, const std::string& form, const std::vector<double>& values,
                   std::size_t object) {
    const double epoch_s = epochOf(position);
    const std::string algorithm = textIn(position, "interpolationAlgorithm");
    int degree = 1;
    if (algorithm == "LAGRANGE" || algorithm == "HERMITE") {  // equal where no velocities are told
      const auto told = position.find("interpolationDegree");
      degree = told != position.end() && told->is_number()
                   ? static_cast<int>(std::clamp(told->get<double>(), 1.0, 12.0))
                   : 1;
    }
    std::vector<EcefSample> samples;
    for (std::size_t i = 0; i < values.size(); i += 4) {
      const double t_s = epoch_s + values[i];
      recorder_.countSample();
      if (degree < 2) {
        recorder_.add(object, poseOf(form, t_s, &values[i + 1]), location_);
        continue;
      }
      if (!samples.empty() && t_s <= samples.back().t_s) {
        countBad(recorder_.tally(), location_, "a time is not after the one before");
        continue;
      }
      samples.push_back({t_s, ecefOf(form, &values[i + 1])});
    }
    addInterpolated(recorder_, object, samples, degree, location_);
  }

  double epochOf(const Json& position) const {
    const auto epoch_s = utcSeconds(textIn(position, "epoch"));
    return epoch_s ? *epoch_s : begin_s_;
  }

  void describe(const Json& packet, std::size_t index) {
    RecordedObject& object = recorder_.object(index);
    const std::string name = printableText(textIn(packet, "name"));
    if (!name.empty()) object.name = name;
    const auto availability = packet.find("availability");
    if (availability == packet.end() || !object.presence.empty()) return;
    int faults = 0;
    const auto intervals = intervalsOf(*availability, faults);
    if (faults > 0) countBad(recorder_.tally(), location_, "its availability is not BEGIN/END in ISO 8601");
    if (intervals.empty()) return;
    // Outside of the intervals the object is absent; they may begin before its positions.
    const double first_s = object.poses.empty() ? begin_s_ : object.poses.front().t_s;
    addPresence(object.presence, first_s, false);
    for (const auto& [begin_s, end_s] : intervals) {
      if (end_s <= first_s) continue;
      addPresence(object.presence, std::max(begin_s, first_s), true);
      if (end_s < kEver_s) addPresence(object.presence, end_s, false);
    }
  }

  static Vec3d ecefOf(const std::string& form, const double* values) {
    if (form == "cartesian") return {values[0], values[1], values[2]};
    const bool is_rad = form == "cartographicRadians";
    const auto degrees = [is_rad](double angle) { return is_rad ? radToDeg(angle) : angle; };
    const double latitude_deg = std::clamp(degrees(values[1]), -90.0, 90.0);
    return toEcef({latitude_deg, std::remainder(degrees(values[0]), 360.0), values[2]});
  }

  static PoseSample poseOf(const std::string& form, double t_s, const double* values) {
    if (form != "cartographicDegrees") return poseOfEcef(t_s, ecefOf(form, values));
    PoseSample pose;
    pose.t_s = t_s;
    pose.longitude_deg = values[0];
    pose.latitude_deg = values[1];
    const bool is_sound = std::abs(values[1]) <= 90 && std::abs(values[0]) <= 720;
    pose.height_msl_m = is_sound ? heightMsl_m(values[1], values[0], values[2]) : values[2];
    return pose;
  }

  static constexpr const char* kForms[] = {"cartographicDegrees", "cartographicRadians", "cartesian"};

  TrackRecorder recorder_;
  std::string location_;
  double begin_s_ = 0;  ///< of the clock
};

}  // namespace

Recording readCzml(ByteSource& source, const std::string& name, const ReadOptions& options) {
  const std::string text = readAll(source, name, kMaxCzmlBytes);
  const auto packets = readJson<Json>(
      text, name, [](Json& json) { return std::move(json); }, "; is the file cut?");
  if (!packets.is_array())
    throw Error(ErrorCode::bad_input, {name, 1, 1},
                "CZML is a list of packets: [{\"id\": \"document\", ...}, ...]");
  return CzmlReader(options).read(packets);
}

}  // namespace emscape::interop
