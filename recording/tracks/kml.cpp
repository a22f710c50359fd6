#include <fmt/format.h>

#include <map>
#include <set>

#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/tracks/track_formats.h"
#include "recording/tracks/xml_tracks.h"

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

class KmlReader : XmlTracks {
 public:
  KmlReader(const std::string& name, const ReadOptions& options) : XmlTracks("KML", name, options) {}

  Recording read(const pugi::xml_node& kml) {
    takeFolder(kml, 0);
    return recorder_.finish();
  }

 private:
  /// A point with a time of its own.
  struct Stamped {
    std::string name, location;
    PoseSample pose;
  };

  void takeFolder(const pugi::xml_node& folder, int depth) {
    std::vector<Stamped> stamped;
    for (const pugi::xml_node& node : folder.children()) {
      if (nameOf(node) == "Placemark") takeGeometries(node, node, nameIn(node), stamped, 0);
      if (nameOf(node) == "Tour") countIgnored(recorder_.tally(), "tour of the camera");
      const bool is_folder = nameOf(node) == "Document" || nameOf(node) == "Folder";
      if (is_folder && depth < kMaxDepth) takeFolder(node, depth + 1);
    }
    takeStamped(stamped, nameIn(folder));
  }

  /// Points of one name are one object; so are those of a folder in the order of time that each have a name
  /// of their own, as trackers of flights write them: the time, for instance.
  void takeStamped(const std::vector<Stamped>& stamped, const std::string& folder) {
    constexpr std::size_t kFewest = 3;
    std::set<std::string> names;
    bool is_ordered = true;
    for (std::size_t i = 0; i < stamped.size(); ++i) {
      names.insert(stamped[i].name);
      is_ordered = is_ordered && (i == 0 || stamped[i].pose.t_s > stamped[i - 1].pose.t_s);
    }
    if (stamped.size() >= kFewest && is_ordered && names.size() == stamped.size()) {
      const std::size_t object = newObject(folder);
      recorder_.tally().notes.push_back(fmt::format(
          "{} points in the order of their times, each with a name of its own, are taken as one object, '{}'",
          stamped.size(), recorder_.object(object).name));
      for (const Stamped& point : stamped) recorder_.add(object, point.pose, point.location);
      return;
    }
    for (const Stamped& point : stamped) {
      const auto [found, is_new] = stamped_.try_emplace(point.name, 0);
      if (is_new) found->second = newObject(point.name);
      recorder_.add(found->second, point.pose, point.location);
    }
  }

  void takeGeometries(const pugi::xml_node& placemark, const pugi::xml_node& parent, const std::string& name,
                      std::vector<Stamped>& stamped, int depth) {
    for (const pugi::xml_node& node : parent.children()) {
      if (nameOf(node) == "MultiGeometry" && depth < kMaxDepth)
        takeGeometries(placemark, node, name, stamped, depth + 1);
      if (nameOf(node) == "Track") takeTrack(node, newObject(name));
      if (nameOf(node) == "MultiTrack") {
        const std::size_t object = newObject(name);
        for (const pugi::xml_node& track : node.children()) {
          if (nameOf(track) == "Track") takeTrack(track, object);
        }
      }
      if (nameOf(node) == "Point") takePoint(placemark, node, name, stamped);
      if (nameOf(node) == "LineString") countIgnored(recorder_.tally(), "line without times");
    }
  }

  /// Heights are above mean sea level; those that are not absolute are relative to a ground that is not
  /// known.
  double heightOf(const pugi::xml_node& geometry, double told_m) {
    const std::string mode = textOf(geometry, "altitudeMode");
    if (mode == "absolute") return told_m;
    if (mode == "relativeToGround" || mode == "relativeToSeaFloor") {
      recorder_.assumeHeight(fmt::format("altitudeMode {}: the height is taken as above mean sea level; {}",
                                         mode, kHeightsAboveGround));
      return told_m;
    }
    recorder_.assumeHeight(
        "height of an object on the ground: 0 m is taken; 'height_agl_m: 0' of a track puts it there");
    return 0;
  }

  void takePoint(const pugi::xml_node& placemark, const pugi::xml_node& point, const std::string& name,
                 std::vector<Stamped>& stamped) {
    const std::string location = nextLocation("position");
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
    if (when.empty()) return recorder_.addFixed(newObject(name), pose, location);
    const auto time_s = utcSeconds(when);
    if (!time_s) return countBad(recorder_.tally(), location, "its time is not ISO 8601");
    if (!hasZone(when)) recorder_.assume(kUtcWithoutZone);
    pose.t_s = *time_s;
    stamped.push_back({name, location, pose});
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
      const std::string location = nextLocation("position");
      if (trimmed(places[i]).empty()) continue;  // the standard's way to leave a time out
      const auto time_s = utcSeconds(times[i]);
      const std::vector<double> at = numbersOf(places[i]);
      if (!time_s || at.size() < 2) {
        countBad(recorder_.tally(), location, "no ISO 8601 time, or no position LONGITUDE LATITUDE HEIGHT");
        continue;
      }
      if (!hasZone(times[i])) recorder_.assume(kUtcWithoutZone);
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

  std::map<std::string, std::size_t> stamped_;  ///< objects of stamped points, by name
};

}  // namespace

Recording readKml(ByteSource& source, const std::string& name, const ReadOptions& options) {
  return readXmlTracks<KmlReader>(source, name, options, "kml");
}

}  // namespace emscape::interop
