#include "study/files/czml.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "base/text/xml_text.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/playback/frames/scene.h"
#include "render/annotate/overlay_parts.h"
#include "scenario/terrain/transformation.h"
#include "study/files/map_shapes.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_objects.h"

namespace emscape::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPolygonOpacity = 150;  ///< of 255, of the polygons

Json colorJson(const render::Rgb& color, int alpha) {
  const auto level = [](float part) { return static_cast<int>(std::lround(255 * part)); };
  return {{"rgba", {level(color.r), level(color.g), level(color.b), alpha}}};
}

/// Longitude, latitude (1e-7 degrees) and height above the ellipsoid (cm).
void addPosition(Json& list, double longitude_deg, double latitude_deg, double height_m) {
  list.push_back(std::round(longitude_deg * 1e7) / 1e7);
  list.push_back(std::round(latitude_deg * 1e7) / 1e7);
  list.push_back(std::round(height_m * 100) / 100);
}

class Czml : public MapCollection {
 public:
  Czml(const std::filesystem::path& file, const MapStudy& study) : file_(file), study_(study) {
    const double duration_s = study.scenarios.front()->clock.duration_s;
    begin_s_ = std::min(0.0, study.times_s.front());
    end_s_ = std::max(duration_s, endOf(study, study.times_s.back()));
    to_earth_ = scenario::transformationBetween(referenceOf(*study.grid), scenario::wgs84Reference());
    packets_.push_back({{"id", "document"},
                        {"name", study.title},
                        {"version", "1.0"},
                        {"clock",
                         {{"interval", intervalOf(begin_s_, end_s_)},
                          {"currentTime", utcOf(study, study.times_s.front())},
                          {"multiplier", 1}}}});
    addTracks();
    addEmitters();
  }

  void add(const Map& map) override {
    if (map.kind != MapKind::classes) return;
    const std::string height = map.height ? ", " + describe(*map.height) : "";
    const std::string group = map.name + height;
    if (std::find(groups_.begin(), groups_.end(), group) == groups_.end()) {
      groups_.push_back(group);
      packets_.push_back({{"id", "group/" + group}, {"name", map.title + height}});
    }
    const MapShapes shapes = shapesOf(*study_.grid, map, file_);
    int number = 0;
    for (const MapBand& band : shapes.bands) {
      for (int n = 0; n < OGR_G_GetGeometryCount(band.geometry.get()); ++n) {
        Json packet{{"id", fileNameOf(map) + "/" + std::to_string(number++)},
                    {"name", map.description},
                    {"parent", "group/" + group}};
        if (map.time_s) packet["availability"] = intervalOf(*map.time_s, endOf(study_, *map.time_s));
        packet["polygon"] = polygonJson(map, OGR_G_GetGeometryRef(band.geometry.get(), n));
        packet["polygon"]["show"] = group == groups_.front();
        packet["polygon"]["material"]["solidColor"]["color"] =
            colorJson(band.color.value_or(render::Rgb{}), kPolygonOpacity);
        packets_.push_back(std::move(packet));
      }
    }
  }

  void finish() override {
    writeWhole(file_, [&](std::ostream& out) { out << dumpJson(packets_) << "\n"; });
  }

 private:
  std::string intervalOf(double begin_s, double end_s) const {
    return utcOf(study_, begin_s) + "/" + utcOf(study_, end_s);
  }

  /// Platforms that move; emitters refer to them.
  void addTracks() {
    for (const MapTrack& track : tracksOf(study_)) {
      Json samples = Json::array();
      for (const MapPosition& at : track.positions) {
        samples.push_back(at.time_s);
        addPosition(samples, at.position.longitude_deg, at.position.latitude_deg,
                    at.position.height_ellipsoid_m);
      }
      const bool holds = track.platform->outside_track == scenario::OutsideTrack::hold;
      const char* const outside = holds ? "HOLD" : "NONE";
      Json packet{{"id", "track/" + std::to_string(tracks_.size())}, {"name", track.platform->name}};
      if (!holds)
        packet["availability"] = intervalOf(track.positions.front().time_s, track.positions.back().time_s);
      packet["position"] = {{"epoch", utcOf(study_, 0)},
                            {"cartographicDegrees", samples},
                            {"interpolationAlgorithm", "LINEAR"},
                            {"forwardExtrapolationType", outside},
                            {"backwardExtrapolationType", outside}};
      packet["path"] = {{"width", 2}, {"material", {{"solidColor", {{"color", colorJson({1, 1, 1}, 200)}}}}}};
      packets_.push_back(std::move(packet));
      tracks_.push_back(track);
    }
  }

  void addEmitters() {
    const std::vector<MapEmitter> emitters = emittersOf(study_);
    for (std::size_t e = 0; e < emitters.size(); ++e) {
      const scenario::Emitter& emitter = *emitters[e].emitter;
      if (!emitter.enabled || emitters[e].positions.empty()) continue;
      const auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const MapTrack& each) {
        return each.platform->name == emitters[e].platform;
      });
      double first_s = begin_s_, last_s = end_s_;  // of the time in which its platform is present
      if (track != tracks_.end() && track->platform->outside_track == scenario::OutsideTrack::absent) {
        first_s = std::max(first_s, track->positions.front().time_s);
        last_s = std::min(last_s, track->positions.back().time_s);
      }
      Json packet{{"id", "emitter/" + std::to_string(e)},
                  {"name", emitter.name},
                  {"description", escapedXml(std::string(scenario::toString(emitter.kind)) + " on " +
                                             emitters[e].platform)}};
      Json availability = Json::array();
      for (const scenario::TimeInterval& active : emitter.active_s) {
        const double begin_s = std::max(active.begin_s, first_s), end_s = std::min(active.end_s, last_s);
        if (begin_s < end_s) availability.push_back(intervalOf(begin_s, end_s));
      }
      if (!emitter.active_s.empty() && availability.empty()) continue;  // never active
      if (availability.empty() && (first_s > begin_s_ || last_s < end_s_)) {
        availability.push_back(intervalOf(first_s, last_s));
      }
      if (!availability.empty()) packet["availability"] = availability;
      if (track != tracks_.end()) {
        packet["position"] = {
            {"reference", "track/" + std::to_string(track - tracks_.begin()) + "#position"}};
      } else {
        Json place = Json::array();
        const GeodeticPosition& at = emitters[e].positions.front().position;
        addPosition(place, at.longitude_deg, at.latitude_deg, at.height_ellipsoid_m);
        packet["position"] = {{"cartographicDegrees", place}};
      }
      packet["point"] = {{"pixelSize", 10},
                         {"color", colorJson(render::colorOf(playback::markerKindOf(emitter.kind)), 255)},
                         {"outlineColor", colorJson({0, 0, 0}, 255)},
                         {"outlineWidth", 1}};
      packet["label"] = {{"text", emitter.name},
                         {"font", "12pt sans-serif"},
                         {"horizontalOrigin", "LEFT"},
                         {"pixelOffset", {{"cartesian2", {10, 0}}}}};
      packets_.push_back(std::move(packet));
    }
  }

  Json ringJson(const Map& map, OGRGeometryH ring) const {
    const bool floats = map.height && map.height->reference == emfield::HeightReference::mean_sea_level;
    Json list = Json::array();
    for (int n = 0; n + 1 < OGR_G_GetPointCount(ring); ++n) {  // the last point is the first
      double x = OGR_G_GetX(ring, n), y = OGR_G_GetY(ring, n);
      OCTTransform(to_earth_.get(), 1, &x, &y, nullptr);
      addPosition(list, x, y, floats ? map.height->metres + geoidUndulation_m(y, x) : 0);
    }
    return list;
  }

  /// @param polygon  its rings are the outer one, then the holes
  Json polygonJson(const Map& map, OGRGeometryH polygon) const {
    Json json{{"positions", {{"cartographicDegrees", ringJson(map, OGR_G_GetGeometryRef(polygon, 0))}}}};
    Json holes = Json::array();
    for (int n = 1; n < OGR_G_GetGeometryCount(polygon); ++n) {
      holes.push_back(ringJson(map, OGR_G_GetGeometryRef(polygon, n)));
    }
    if (!holes.empty()) json["holes"] = {{"cartographicDegrees", holes}};
    if (map.height && map.height->reference == emfield::HeightReference::mean_sea_level) {
      json["perPositionHeight"] = true;
    }
    return json;
  }

  const std::filesystem::path file_;
  const MapStudy& study_;
  double begin_s_ = 0, end_s_ = 0;
  gdal::Transformation to_earth_;
  std::vector<MapTrack> tracks_;
  std::vector<std::string> groups_;
  Json packets_ = Json::array();
};

}  // namespace

std::unique_ptr<MapCollection> makeCzml(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<Czml>(file, study);
}

}  // namespace emscape::study
