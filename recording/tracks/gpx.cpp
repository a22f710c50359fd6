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

class GpxReader {
 public:
  GpxReader(const std::string& name, const ReadOptions& options)
      : stem_(std::filesystem::path(name).stem().string()), recorder_("GPX", options) {
    recorder_.hasUtc();
  }

  Recording read(const pugi::xml_node& gpx) {
    for (const pugi::xml_node& node : gpx.children()) {
      if (nameOf(node) == "trk") takeTrack(node);
      if (nameOf(node) == "wpt") takePoint(node, objectOf(node, "waypoint"), true);
      if (nameOf(node) == "rte") countIgnored(recorder_.tally(), "route without times");
    }
    return recorder_.finish();
  }

 private:
  std::size_t objectOf(const pugi::xml_node& node, const std::string& otherwise) {
    // Objects may have the same name.
    const std::size_t object = recorder_.objectOf(fmt::format("{}", ++objects_));
    const std::string told = printableText(textOf(node, "name"));
    recorder_.object(object).name = told.empty() ? otherwise : told;
    recorder_.object(object).type = printableText(textOf(node, "type"));
    return object;
  }

  void takeTrack(const pugi::xml_node& track) {
    const std::size_t object = objectOf(track, stem_);
    for (const pugi::xml_node& segment : track.children()) {
      if (nameOf(segment) != "trkseg") continue;
      for (const pugi::xml_node& point : segment.children()) {
        if (nameOf(point) == "trkpt") takePoint(point, object, false);
      }
    }
  }

  void takePoint(const pugi::xml_node& point, std::size_t object, bool is_fixed) {
    const std::string location = fmt::format("point {}", ++recorder_.tally().records);
    const auto latitude = numberIn(point.attribute("lat").value()),
               longitude = numberIn(point.attribute("lon").value());
    if (!latitude || !longitude)
      return countBad(recorder_.tally(), location, "it has no numbers lat and lon");
    PoseSample pose;
    pose.latitude_deg = *latitude;
    pose.longitude_deg = *longitude;
    const std::string height = textOf(point, "ele");
    pose.height_msl_m = numberIn(height).value_or(0);
    if (height.empty()) recorder_.assume("height of a point without ele: 0 m is taken");
    if (is_fixed) return recorder_.addFixed(object, pose, location);
    const auto time_s = utcSeconds(textOf(point, "time"));
    if (!time_s) return countBad(recorder_.tally(), location, "it has no time (ISO 8601)");
    pose.t_s = *time_s;
    pose.heading_deg = numberIn(textOf(point, "course")).value_or(kUnknown);  // of GPX 1.0
    recorder_.add(object, pose, location);
  }

  std::string stem_;
  TrackRecorder recorder_;
  int objects_ = 0;
};

}  // namespace

Recording readGpx(ByteSource& source, const std::string& name, const ReadOptions& options) {
  pugi::xml_document document;
  const std::string torn = loadXml(source, name, document);
  Recording recording = GpxReader(name, options).read(childOf(document, "gpx"));
  recording.tally.torn = torn;
  return recording;
}

}  // namespace emscape::interop
