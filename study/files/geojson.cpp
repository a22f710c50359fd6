#include "study/files/geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "emscape/base/units.h"
#include "scenario/terrain/transformation.h"
#include "study/files/map_shapes.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_objects.h"

namespace emscape::study {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Longitude and latitude, to 1e-7 degrees.
OrderedJson placeJson(double longitude_deg, double latitude_deg) {
  return {std::round(longitude_deg * 1e7) / 1e7, std::round(latitude_deg * 1e7) / 1e7};
}
OrderedJson pointJson(const MapPosition& at) {
  return {{"type", "Point"}, {"coordinates", placeJson(at.position.longitude_deg, at.position.latitude_deg)}};
}

class GeoJson : public MapCollection {
 public:
  GeoJson(const std::filesystem::path& file, const MapStudy& study)
      : file_(file),
        study_(study),
        to_earth_(scenario::transformationBetween(referenceOf(*study.grid), scenario::wgs84Reference())) {}

  void add(const Map& map) override {
    for (const MapBand& band : shapesOf(*study_.grid, map, file_).bands) {
      OrderedJson properties{{"layer", "bands"}, {"product", map.name}, {"description", map.description}};
      if (map.height) {
        properties["height_m"] = map.height->metres;
        properties["height_above"] =
            map.height->reference == emfield::HeightReference::ground ? "ground" : "mean sea level";
      }
      if (map.time_s) addTimes(properties, *map.time_s);
      properties["min"] = band.min;
      properties["max"] = band.max;
      properties["unit"] = map.unit;
      if (!band.label.empty()) properties["label"] = band.label;
      if (band.color) {
        properties["fill"] = colorText(*band.color);
        properties["stroke"] = properties["fill"];
      }
      addFeature(properties, shapeJson(band.geometry.get()));
    }
  }

  void finish() override {
    addEmitters();
    addSites();
    addTracks();
    writeWhole(file_, [&](std::ostream& out) {
      out << dumpJson(
                 OrderedJson{{"type", "FeatureCollection"}, {"name", study_.title}, {"features", features_}})
          << "\n";
    });
  }

 private:
  static std::string colorText(const render::Rgb& color) {
    const auto level = [](float part) { return std::lround(255 * std::clamp(part, 0.0f, 1.0f)); };
    return fmt::format("#{:02x}{:02x}{:02x}", level(color.r), level(color.g), level(color.b));
  }
  void addTimes(OrderedJson& properties, double time_s) const {
    properties["time"] = utcOf(study_, time_s);
    properties["time_end"] = utcOf(study_, endOf(study_, time_s));
  }
  void addFeature(const OrderedJson& properties, const OrderedJson& geometry) {
    features_.push_back({{"type", "Feature"}, {"properties", properties}, {"geometry", geometry}});
  }

  void addEmitters() {
    for (const MapEmitter& emitter : emittersOf(study_)) {
      for (const MapPosition& at : emitter.positions) {
        OrderedJson properties{{"layer", "emitters"},
                               {"name", emitter.emitter->name},
                               {"kind", scenario::toString(emitter.emitter->kind)},
                               {"platform", emitter.platform},
                               {"enabled", emitter.emitter->enabled},
                               {"frequency_hz", emitter.emitter->frequency_hz},
                               {"power_w", emitter.emitter->power_w},
                               {"height_msl_m", at.height_msl_m}};
        if (emitter.is_moving) addTimes(properties, at.time_s);
        addFeature(properties, pointJson(at));
      }
    }
  }
  void addSites() {
    for (const MapSite& site : sitesOf(study_)) {
      for (const MapPosition& at : site.positions) {
        OrderedJson properties{{"layer", "sites"},          {"name", site.platform},
                               {"emitters", site.emitters}, {"receivers", site.receivers},
                               {"targets", site.targets},   {"height_msl_m", at.height_msl_m}};
        if (site.is_moving) addTimes(properties, at.time_s);
        addFeature(properties, pointJson(at));
      }
    }
  }
  void addTracks() {
    for (const MapTrack& track : tracksOf(study_)) {
      for (const MapTrack& part : cutAtAntimeridian(track)) {
        OrderedJson line = OrderedJson::array(), times = OrderedJson::array();
        for (const MapPosition& at : part.positions) {
          line.push_back(placeJson(at.position.longitude_deg, at.position.latitude_deg));
          times.push_back(utcOf(study_, at.time_s));
        }
        addFeature({{"layer", "tracks"}, {"platform", part.platform->name}, {"times", times}},
                   {{"type", "LineString"}, {"coordinates", line}});
      }
    }
  }

  /// Outer rings run counterclockwise, holes clockwise; the last point is the first.
  OrderedJson outlineJson(OGRGeometryH ring, bool is_outer) const {
    std::vector<std::array<double, 2>> points;
    double twice_area = 0;
    for (int n = 0; n < OGR_G_GetPointCount(ring); ++n) {
      double x = OGR_G_GetX(ring, n), y = OGR_G_GetY(ring, n);
      OCTTransform(to_earth_.get(), 1, &x, &y, nullptr);
      if (!points.empty()) {
        x = points.back()[0] + wrapLongitude_deg(x - points.back()[0]);
        twice_area += points.back()[0] * y - x * points.back()[1];
      }
      points.push_back({x, y});
    }
    if ((twice_area > 0) != is_outer) std::reverse(points.begin(), points.end());
    OrderedJson list = OrderedJson::array();
    for (const auto& [x, y] : points) list.push_back(placeJson(x, y));
    return list;
  }
  OrderedJson shapeJson(OGRGeometryH shape) const {
    OrderedJson polygons = OrderedJson::array();
    for (int p = 0; p < OGR_G_GetGeometryCount(shape); ++p) {
      OGRGeometryH polygon = OGR_G_GetGeometryRef(shape, p);
      OrderedJson rings = OrderedJson::array();
      for (int n = 0; n < OGR_G_GetGeometryCount(polygon); ++n)
        rings.push_back(outlineJson(OGR_G_GetGeometryRef(polygon, n), n == 0));
      polygons.push_back(rings);
    }
    return {{"type", "MultiPolygon"}, {"coordinates", polygons}};
  }

  const std::filesystem::path file_;
  const MapStudy& study_;
  gdal::Transformation to_earth_;
  OrderedJson features_ = OrderedJson::array();
};

}  // namespace

std::unique_ptr<MapCollection> makeGeoJson(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<GeoJson>(file, study);
}

}  // namespace emscape::study
