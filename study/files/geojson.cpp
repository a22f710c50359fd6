#include "study/files/geojson.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

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

using Ring =
    std::vector<std::array<double, 2>>;  ///< longitudes and latitudes (deg); the last point is the first

/// Outer rings run counterclockwise, holes clockwise.
OrderedJson polygonJson(const std::vector<Ring>& rings) {
  OrderedJson json = OrderedJson::array();
  for (Ring ring : rings) {
    double twice_area = 0;
    for (std::size_t n = 1; n < ring.size(); ++n)
      twice_area += ring[n - 1][0] * ring[n][1] - ring[n][0] * ring[n - 1][1];
    if ((twice_area > 0) != json.empty()) std::reverse(ring.begin(), ring.end());
    OrderedJson list = OrderedJson::array();
    for (const auto& [x, y] : ring) list.push_back(placeJson(x, y));
    json.push_back(list);
  }
  return json;
}

gdal::Geometry geometryOf(const std::vector<Ring>& rings) {
  gdal::Geometry polygon(OGR_G_CreateGeometry(wkbPolygon));
  for (const Ring& ring : rings) {
    OGRGeometryH outline = OGR_G_CreateGeometry(wkbLinearRing);
    for (const auto& [x, y] : ring) OGR_G_SetPoint_2D(outline, OGR_G_GetPointCount(outline), x, y);
    OGR_G_AddGeometryDirectly(polygon.get(), outline);
  }
  return polygon;
}

void addPolygons(OGRGeometryH geometry, double shift_deg, std::vector<std::vector<Ring>>& parts) {
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
  const int count = OGR_G_GetGeometryCount(geometry);
  if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (int n = 0; n < count; ++n) addPolygons(OGR_G_GetGeometryRef(geometry, n), shift_deg, parts);
  }
  if (type != wkbPolygon || count == 0) return;
  parts.emplace_back();
  for (int n = 0; n < count; ++n) {
    OGRGeometryH outline = OGR_G_GetGeometryRef(geometry, n);
    Ring ring;
    for (int k = 0; k < OGR_G_GetPointCount(outline); ++k)
      ring.push_back({OGR_G_GetX(outline, k) + shift_deg, OGR_G_GetY(outline, k)});
    parts.back().push_back(std::move(ring));
  }
}

/// The parts of a polygon within -180 to 180 degrees of longitude (RFC 7946, 3.1.9).
std::vector<std::vector<Ring>> withinOneTurn(const std::vector<Ring>& rings) {
  constexpr double kTurn_deg = 360, kHalf_deg = 180;
  const auto isWithin = [](const std::array<double, 2>& at) { return std::abs(at[0]) <= kHalf_deg; };
  if (std::all_of(rings.front().begin(), rings.front().end(), isWithin)) return {rings};
  std::vector<std::vector<Ring>> parts;
  const gdal::Geometry polygon = geometryOf(rings);
  for (const double turn_deg : {-kTurn_deg, 0.0, kTurn_deg}) {
    const double west = turn_deg - kHalf_deg, east = turn_deg + kHalf_deg;
    const gdal::Geometry zone = geometryOf({{{west, -90}, {east, -90}, {east, 90}, {west, 90}, {west, -90}}});
    const gdal::Geometry part(OGR_G_Intersection(polygon.get(), zone.get()));
    if (part != nullptr) addPolygons(part.get(), -turn_deg, parts);
  }
  return parts.empty() ? std::vector<std::vector<Ring>>{rings} : parts;
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

  /// A ring without a step of a turn. @param near_deg  longitude within half a turn of its first point; NaN:
  /// any
  Ring ringOf(OGRGeometryH outline, double near_deg) const {
    Ring ring;
    for (int n = 0; n < OGR_G_GetPointCount(outline); ++n) {
      double x = OGR_G_GetX(outline, n), y = OGR_G_GetY(outline, n);
      OCTTransform(to_earth_.get(), 1, &x, &y, nullptr);
      if (!ring.empty()) near_deg = ring.back()[0];
      if (!std::isnan(near_deg)) x = near_deg + wrapLongitude_deg(x - near_deg);
      ring.push_back({x, y});
    }
    return ring;
  }
  OrderedJson shapeJson(OGRGeometryH shape) const {
    OrderedJson polygons = OrderedJson::array();
    for (int p = 0; p < OGR_G_GetGeometryCount(shape); ++p) {
      OGRGeometryH polygon = OGR_G_GetGeometryRef(shape, p);
      std::vector<Ring> rings;
      for (int n = 0; n < OGR_G_GetGeometryCount(polygon); ++n) {
        const double near_deg = n == 0 || rings.front().empty() ? std::nan("") : rings.front().front()[0];
        rings.push_back(ringOf(OGR_G_GetGeometryRef(polygon, n), near_deg));
      }
      for (const std::vector<Ring>& part : withinOneTurn(rings)) polygons.push_back(polygonJson(part));
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
