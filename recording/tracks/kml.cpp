#include <fmt/format.h>

#include <filesystem>

#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/common/xml.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

constexpr int kMaxDepth = 64;  ///< of folders

/// Numbers that blanks or commas separate: programs mix up the two forms of the standard.
std::vector<double> numbersOf(std::string_view text) {
  constexpr std::string_view kSeparators = ", \t\r\n";
  std::vector<double> numbers;
  for (;;) {
    const std::size_t begin = text.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) return numbers;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(kSeparators), text.size());
    const auto number = numberIn(text.substr(0, end));
    if (!number) return {};
    numbers.push_back(*number);
    text.remove_prefix(end);
  }
}

class KmlReader {
 public:
  KmlReader(const std::string& name, const ReadOptions& options)
      : stem_(std::filesystem::path(name).stem().string()), recorder_("KML", options) {
    recorder_.hasUtc();
  }

  Recording read(const pugi::xml_node& kml) {
    takeFolder(kml, 0);
    return recorder_.finish();
  }

 private:
  void takeFolder(const pugi::xml_node& folder, int depth) {
    for (const pugi::xml_node& node : folder.children()) {
      if (nameOf(node) == "Placemark") takePlacemark(node);
      if (nameOf(node) == "Tour") countIgnored(recorder_.tally(), "tour of the camera");
      const bool is_folder = nameOf(node) == "Document" || nameOf(node) == "Folder";
      if (is_folder && depth < kMaxDepth) takeFolder(node, depth + 1);
    }
  }

  std::size_t objectOf(const std::string& id, const std::string& name) {
    const std::size_t object = recorder_.objectOf(id);
    recorder_.object(object).name = name;
    return object;
  }

  void takePlacemark(const pugi::xml_node& placemark) {
    const std::string told = printableText(textOf(placemark, "name"));
    takeGeometries(placemark, placemark, told.empty() ? stem_ : told, 0);
  }

  void takeGeometries(const pugi::xml_node& placemark, const pugi::xml_node& parent, const std::string& name,
                      int depth) {
    for (const pugi::xml_node& node : parent.children()) {
      if (nameOf(node) == "MultiGeometry" && depth < kMaxDepth)
        takeGeometries(placemark, node, name, depth + 1);
      if (nameOf(node) == "Track") takeTrack(node, objectOf(fmt::format("track {}", ++tracks_), name));
      if (nameOf(node) == "MultiTrack") {
        const std::size_t object = objectOf(fmt::format("track {}", ++tracks_), name);
        for (const pugi::xml_node& track : node.children()) {
          if (nameOf(track) == "Track") takeTrack(track, object);
        }
      }
      if (nameOf(node) == "Point") takePoint(placemark, node, name);
      if (nameOf(node) == "LineString") countIgnored(recorder_.tally(), "line without times");
    }
  }

  /// Heights are above mean sea level; those that are not absolute are relative to a ground that is not
  /// known.
  double heightOf(const pugi::xml_node& geometry, double told_m) {
    const std::string mode = textOf(geometry, "altitudeMode");
    if (mode == "absolute") return told_m;
    if (mode == "relativeToGround" || mode == "relativeToSeaFloor") {
      recorder_.assume("altitudeMode " + mode + ": the height is taken as above mean sea level");
      return told_m;
    }
    recorder_.assume("height of an object on the ground: 0 m is taken");
    return 0;
  }

  void takePoint(const pugi::xml_node& placemark, const pugi::xml_node& point, const std::string& name) {
    const std::string location = fmt::format("position {}", ++recorder_.tally().records);
    const std::vector<double> at = numbersOf(textOf(point, "coordinates"));
    if (at.size() < 2) {
      return countBad(recorder_.tally(), location,
                      "its coordinates are not LONGITUDE,LATITUDE or LONGITUDE,LATITUDE,HEIGHT");
    }
    PoseSample pose;
    pose.longitude_deg = at[0];
    pose.latitude_deg = at[1];
    pose.height_msl_m = heightOf(point, at.size() > 2 ? at[2] : 0);
    std::string when = textOf(childOf(placemark, "TimeStamp"), "when");
    if (when.empty()) when = textOf(childOf(placemark, "TimeSpan"), "begin");
    if (when.empty())
      return recorder_.addFixed(objectOf(fmt::format("point {}", ++points_), name), pose, location);
    const auto time_s = utcSeconds(when);
    if (!time_s) return countBad(recorder_.tally(), location, "its time is not ISO 8601");
    pose.t_s = *time_s;
    recorder_.add(objectOf("stamped " + name, name), pose, location);
  }

  void takeTrack(const pugi::xml_node& track, std::size_t object) {
    std::vector<std::string_view> times, places, angles;
    for (const pugi::xml_node& node : track.children()) {
      if (nameOf(node) == "when") times.emplace_back(node.child_value());
      if (nameOf(node) == "coord") places.emplace_back(node.child_value());
      if (nameOf(node) == "angles") angles.emplace_back(node.child_value());
    }
    if (times.size() != places.size()) {
      return countBad(recorder_.tally(), recorder_.object(object).name,
                      fmt::format("a track of {} times and {} positions", times.size(), places.size()));
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      const std::string location = fmt::format("position {}", ++recorder_.tally().records);
      if (trimmed(places[i]).empty()) continue;  // the standard's way to leave a time out
      const auto time_s = utcSeconds(times[i]);
      const std::vector<double> at = numbersOf(places[i]);
      if (!time_s || at.size() < 2) {
        countBad(recorder_.tally(), location, "no ISO 8601 time, or no position LONGITUDE LATITUDE HEIGHT");
        continue;
      }
      PoseSample pose;
      pose.t_s = *time_s;
      pose.longitude_deg = at[0];
      pose.latitude_deg = at[1];
      pose.height_msl_m = heightOf(track, at.size() > 2 ? at[2] : 0);
      const std::vector<double> turned = i < angles.size() ? numbersOf(angles[i]) : std::vector<double>();
      if (turned.size() == 3) {  // heading, tilt (nose up), roll
        pose.heading_deg = turned[0];
        pose.pitch_deg = turned[1];
        pose.roll_deg = turned[2];
      }
      recorder_.add(object, pose, location);
    }
  }

  std::string stem_;
  TrackRecorder recorder_;
  int tracks_ = 0, points_ = 0;
};

}  // namespace

Recording readKml(ByteSource& source, const std::string& name, const ReadOptions& options) {
  pugi::xml_document document;
  const std::string torn = loadXml(source, name, document);
  Recording recording = KmlReader(name, options).read(childOf(document, "kml"));
  recording.tally.torn = torn;
  return recording;
}

}  // namespace emscape::interop
