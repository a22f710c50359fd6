#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/tracks/track_formats.h"
#include "recording/tracks/xml_tracks.h"

namespace emscape::interop {
namespace {

class GpxReader : XmlTracks {
 public:
  GpxReader(const std::string& name, const ReadOptions& options) : XmlTracks("GPX", name, options) {}

  Recording read(const pugi::xml_node& gpx) {
    for (const pugi::xml_node& node : gpx.children()) {
      if (nameOf(node) == "trk") takeTrack(node);
      if (nameOf(node) == "wpt") {
        const std::string told = nameIn(node);
        takePoint(node, objectOf(node, told.empty() ? "waypoint" : told), true);
      }
      if (nameOf(node) == "rte") takeRoute(node);
    }
    return recorder_.finish();
  }

 private:
  std::size_t objectOf(const pugi::xml_node& node, const std::string& name) {
    const std::size_t object = newObject(name);
    recorder_.object(object).type = printableText(textOf(node, "type"));
    return object;
  }

  void takeTrack(const pugi::xml_node& track) {
    const std::size_t object = objectOf(track, nameIn(track));
    for (const pugi::xml_node& segment : track.children()) {
      if (nameOf(segment) == "trkseg") takePoints(segment, "trkpt", object);
    }
  }

  /// Routes are planned, but some receivers write what was travelled as one.
  void takeRoute(const pugi::xml_node& route) {
    for (const pugi::xml_node& point : route.children()) {
      if (nameOf(point) == "rtept" && childOf(point, "time"))
        return takePoints(route, "rtept", objectOf(route, nameIn(route)));
    }
    countIgnored(recorder_.tally(), "route without times");
  }

  void takePoints(const pugi::xml_node& parent, std::string_view name, std::size_t object) {
    for (const pugi::xml_node& point : parent.children()) {
      if (nameOf(point) == name) takePoint(point, object, false);
    }
  }

  void takePoint(const pugi::xml_node& point, std::size_t object, bool is_fixed) {
    const std::string location = nextLocation("point");
    const auto latitude = numberIn(point.attribute("lat").value()),
               longitude = numberIn(point.attribute("lon").value());
    if (!latitude || !longitude)
      return countBad(recorder_.tally(), location, "it has no numbers lat and lon");
    PoseSample pose;
    pose.latitude_deg = *latitude;
    pose.longitude_deg = *longitude;
    pose.height_msl_m = numberIn(textOf(point, "ele")).value_or(kUnknown);
    if (is_fixed) return recorder_.addFixed(object, pose, location);
    const std::string time = textOf(point, "time");
    const auto time_s = utcSeconds(time);
    if (!time_s) return countBad(recorder_.tally(), location, "it has no time (ISO 8601)");
    if (!hasZone(time)) recorder_.assume(kUtcWithoutZone);
    pose.t_s = *time_s;
    pose.heading_deg = numberIn(textOf(point, "course")).value_or(kUnknown);  // of GPX 1.0
    recorder_.add(object, pose, location);
  }
};

}  // namespace

Recording readGpx(ByteSource& source, const std::string& name, const ReadOptions& options) {
  return readXmlTracks<GpxReader>(source, name, options, "gpx");
}

}  // namespace emscape::interop
