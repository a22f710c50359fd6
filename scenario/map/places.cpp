#include "scenario/map/places.h"

#include <fmt/format.h>

#include <cmath>

#include "emscape/base/error.h"
#include "scenario/map/point_table.h"
#include "scenario/map/vector_file.h"
#include "scenario/terrain/transformation.h"

namespace emscape::scenario {
namespace {

/// Index of the field that holds the names; -1: none.
int nameField(OGRLayerH layer) {
  const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
  for (const char* const name : {"name", "Name", "NAME"}) {
    const int field = OGR_FD_GetFieldIndex(definition, name);
    if (field >= 0) return field;
  }
  return -1;
}

class PlaceReader {
 public:
  explicit PlaceReader(const std::string& file) : file_(file), vectors_(file) {}

  std::vector<Place> read() {
    for (OGRLayerH layer : vectors_.layers()) addLayer(layer);
    if (places_.empty())
      fail(
          "has no place: features need points, lines or areas, a table the columns latitude_deg and "
          "longitude_deg, or a position");
    return std::move(places_);
  }

 private:
  void addLayer(OGRLayerH layer) {
    transformation_.reset();
    if (OGR_L_GetSpatialRef(layer) != nullptr) {
      const gdal::SpatialReference own(OSRClone(OGR_L_GetSpatialRef(layer)));
      OSRSetAxisMappingStrategy(own.get(), OAMS_TRADITIONAL_GIS_ORDER);
      transformation_ = transformationBetween(own, wgs84Reference());
    }
    const int name_field = nameField(layer);
    vectors_.eachFeature(layer, [&](OGRFeatureH feature) {
      OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
      if (geometry == nullptr || OGR_G_IsEmpty(geometry) != 0) return;
      const std::string name = name_field < 0 ? "" : OGR_F_GetFieldAsString(feature, name_field);
      const gdal::Geometry straight(OGR_G_GetLinearGeometry(geometry, 0, nullptr));
      add(straight.get(), name);
    });
  }

  void add(OGRGeometryH geometry, const std::string& name) {
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
    const int parts = OGR_G_GetGeometryCount(geometry);
    if (type == wkbPoint || type == wkbLineString) {
      const Place::Kind kind = type == wkbPoint ? Place::Kind::point : Place::Kind::line;
      places_.push_back({kind, name, {positionsOf(geometry)}});
      return;
    }
    if (type == wkbPolygon || type == wkbTriangle) {
      Place area{Place::Kind::area, name, {}};
      for (int i = 0; i < parts; ++i) area.parts.push_back(positionsOf(OGR_G_GetGeometryRef(geometry, i)));
      places_.push_back(std::move(area));
      return;
    }
    for (int i = 0; i < parts; ++i) add(OGR_G_GetGeometryRef(geometry, i), name);
  }

  std::vector<GeodeticPosition> positionsOf(OGRGeometryH line) {
    const int count = OGR_G_GetPointCount(line);
    vertices_ += count;
    if (vertices_ > kMaxPlaceVertices)
      fail(fmt::format("has more than the allowed {} points", kMaxPlaceVertices));
    std::vector<double> x(static_cast<std::size_t>(count)), y(x.size());
    if (count == 0) return {};
    OGR_G_GetPoints(line, x.data(), sizeof(double), y.data(), sizeof(double), nullptr, 0);
    if (transformation_ != nullptr &&
        OCTTransform(transformation_.get(), count, x.data(), y.data(), nullptr) == 0)
      fail("has a point without longitude and latitude");
    std::vector<GeodeticPosition> positions;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(std::abs(y[i]) <= 90 && std::abs(x[i]) <= 360)) {
        fail(fmt::format(
            "has a point at longitude {}, latitude {}, outside the allowed range -180 to 180, -90 to 90",
            x[i], y[i]));
      }
      positions.push_back({y[i], wrapLongitude_deg(x[i]), 0});
    }
    return positions;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::bad_input, {file_, 0, 0}, problem);
  }

  const std::string file_;
  const VectorFile vectors_;
  gdal::Transformation transformation_;  ///< to WGS84; null: the layer has no reference
  std::vector<Place> places_;
  int vertices_ = 0;
};

}  // namespace

std::vector<Place> readPlaces(const std::string& file) {
  if (const auto points = readPointTable(file)) {
    std::vector<Place> places;
    if (points->empty())
      throw Error(ErrorCode::bad_input, {file, 0, 0}, "has no place: the table has no rows");
    for (const NamedPoint& point : *points) {
      places.push_back({Place::Kind::point, point.name, {{{point.latitude_deg, point.longitude_deg, 0}}}});
    }
    return places;
  }
  return PlaceReader(file).read();
}

}  // namespace emscape::scenario
