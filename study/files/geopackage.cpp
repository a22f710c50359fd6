#include "study/files/geopackage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/files/unfinished_file.h"
#include "emscape/playback/frames/scene.h"
#include "render/annotate/overlay_parts.h"
#include "scenario/terrain/transformation.h"
#include "study/files/map_shapes.h"
#include "study/files/qgis_style.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_objects.h"
#include "study/picture/map_picture.h"

namespace emscape::study {
namespace {

/// Sets one of GDAL's options for this thread, in a scope.
class GdalOption {
 public:
  GdalOption(const char* name, const std::string& value) : name_(name) {
    CPLSetThreadLocalConfigOption(name, value.c_str());
  }
  ~GdalOption() { CPLSetThreadLocalConfigOption(name_, nullptr); }
  GdalOption(const GdalOption&) = delete;
  GdalOption& operator=(const GdalOption&) = delete;

 private:
  const char* name_;
};

struct Field {
  const char* name;
  OGRFieldType type;
};

/// A new feature of a layer.
class NewFeature {
 public:
  explicit NewFeature(OGRLayerH layer) : layer_(layer), feature_(OGR_F_Create(OGR_L_GetLayerDefn(layer))) {}

  void set(const char* field, const std::string& text) {
    OGR_F_SetFieldString(feature_.get(), indexOf(field), text.c_str());
  }
  void set(const char* field, double number) { OGR_F_SetFieldDouble(feature_.get(), indexOf(field), number); }
  void setFlag(const char* field, bool flag) {
    OGR_F_SetFieldInteger(feature_.get(), indexOf(field), flag ? 1 : 0);
  }
  /// Copies it.
  void setGeometry(const gdal::Geometry& geometry) { OGR_F_SetGeometry(feature_.get(), geometry.get()); }
  /// @return false if it cannot be written
  bool write() { return OGR_L_CreateFeature(layer_, feature_.get()) == OGRERR_NONE; }

 private:
  int indexOf(const char* field) const { return OGR_F_GetFieldIndex(feature_.get(), field); }

  OGRLayerH layer_;
  gdal::Feature feature_;
};

gdal::Geometry pointAt(const GeodeticPosition& position) {
  gdal::Geometry point(OGR_G_CreateGeometry(wkbPoint));
  OGR_G_SetPoint_2D(point.get(), 0, position.longitude_deg, position.latitude_deg);
  return point;
}

std::string hexOf(const render::Rgb& color) {
  const auto level = [](float part) { return std::lround(255 * std::clamp(part, 0.0f, 1.0f)); };
  return fmt::format("#{:02x}{:02x}{:02x}", level(color.r), level(color.g), level(color.b));
}

class GeoPackage : public MapCollection {
 public:
  GeoPackage(const std::filesystem::path& file, const MapStudy& study) : file_(file), study_(study) {
    const Scope scope(*this);
    try {
      makeLayers(scope);
    } catch (...) {
      dataset_.reset();  // in the scope, which holds back GDAL's messages
      throw;
    }
  }

  ~GeoPackage() override {
    const Scope scope(*this);
    dataset_.reset();
  }

  void add(const Map& map) override {
    const MapShapes shapes = shapesOf(*study_.grid, map, file_.file());
    const Scope scope(*this);
    for (const MapBand& band : shapes.bands) {
      NewFeature feature = featureOf(bands_, map);
      feature.set("min", band.min);
      feature.set("max", band.max);
      feature.set("label", band.label);
      feature.set("color", band.color ? hexOf(*band.color) : "#00000000");
      feature.setGeometry(band.geometry);
      check(scope, feature.write());
    }
    for (const MapLine& line : shapes.lines) {
      NewFeature feature = featureOf(contours_, map);
      feature.set("level", line.level);
      feature.setGeometry(line.geometry);
      check(scope, feature.write());
    }
    addRule(map);
  }

  void finish() override {
    {
      const Scope scope(*this);
      addStyles(scope);
      check(scope, GDALDatasetCommitTransaction(dataset_.get()) == OGRERR_NONE);
      dataset_.reset();
      check(scope, true);
    }
    file_.publish(kAuxiliary);
  }

 private:
  /// GDAL's messages, and its settings for reproducible files.
  struct Scope {
    explicit Scope(const GeoPackage& of)
        : date("OGR_CURRENT_DATE", utcOf(of.study_, 0)), synchronous("OGR_SQLITE_SYNCHRONOUS", "OFF") {}
    GdalOption date, synchronous;
    scenario::GdalMessages messages;
  };

  void check(const Scope& scope, bool is_done) const {
    if (!is_done || scope.messages.hasFailure()) failWriting(scope.messages, file_.file());
  }

  void makeLayers(const Scope& scope) {
    dataset_.reset(GDALCreate(driverOf("GPKG"), file_.temporary().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    check(scope, dataset_ != nullptr);
    GDALDatasetStartTransaction(dataset_.get(), FALSE);
    const gdal::SpatialReference map_reference = referenceOf(*study_.grid),
                                 earth = scenario::wgs84Reference();
    bands_ = addLayer(scope, "bands", map_reference.get(), wkbMultiPolygon,
                      {{"product", OFTString},
                       {"height", OFTReal},
                       {"height_above", OFTString},
                       {"time", OFTDateTime},
                       {"time_end", OFTDateTime},
                       {"min", OFTReal},
                       {"max", OFTReal},
                       {"unit", OFTString},
                       {"label", OFTString},
                       {"color", OFTString},
                       {"description", OFTString}});
    contours_ = addLayer(scope, "contours", map_reference.get(), wkbLineString,
                         {{"product", OFTString},
                          {"height", OFTReal},
                          {"height_above", OFTString},
                          {"time", OFTDateTime},
                          {"time_end", OFTDateTime},
                          {"level", OFTReal},
                          {"unit", OFTString},
                          {"description", OFTString}});
    addEmitters(scope, earth.get());
    addSites(scope, earth.get());
    addTracks(scope, earth.get());
  }

  OGRLayerH addLayer(const Scope& scope, const char* name, OGRSpatialReferenceH reference,
                     OGRwkbGeometryType type, const std::vector<Field>& fields) {
    const char* const options[] = {"ASPATIAL_VARIANT=NOT_REGISTERED", nullptr};
    OGRLayerH layer = GDALDatasetCreateLayer(dataset_.get(), name, reference, type,
                                             type == wkbNone ? const_cast<char**>(options) : nullptr);
    check(scope, layer != nullptr);
    for (const Field& field : fields) {
      const gdal::FieldDefinition definition(OGR_Fld_Create(field.name, field.type));
      check(scope, OGR_L_CreateField(layer, definition.get(), TRUE) == OGRERR_NONE);
    }
    return layer;
  }

  NewFeature featureOf(OGRLayerH layer, const Map& map) const {
    NewFeature feature(layer);
    feature.set("product", map.name);
    feature.set("unit", map.unit);
    feature.set("description", map.description);
    if (map.height) {
      feature.set("height", map.height->metres);
      feature.set("height_above", isAboveGround(map) ? "ground" : "mean sea level");
    }
    if (map.time_s) setTimes(feature, *map.time_s);
    return feature;
  }
  static bool isAboveGround(const Map& map) {
    return map.height->reference == emfield::HeightReference::ground;
  }
  void setTimes(NewFeature& feature, double time_s) const {
    feature.set("time", utcOf(study_, time_s));
    feature.set("time_end", utcOf(study_, endOf(study_, time_s)));
  }

  /// A rule of the style for a product at a height, over all times.
  void addRule(const Map& map) {
    StyleRule rule;
    rule.label = map.title;
    rule.filter = "\"product\" = " + expressionText(map.name);
    if (map.height) {
      rule.label += ", " + describe(*map.height);
      rule.filter += fmt::format(" AND \"height\" = {} AND \"height_above\" = {}", map.height->metres,
                                 expressionText(isAboveGround(map) ? "ground" : "mean sea level"));
    }
    const auto is_same = [&](const StyleRule& other) { return other.filter == rule.filter; };
    if (std::any_of(band_rules_.begin(), band_rules_.end(), is_same)) return;
    rule.is_on = band_rules_.empty();
    band_rules_.push_back(rule);
    if (isWhole(map.kind)) return;
    rule.is_on = contour_rules_.empty();
    contour_rules_.push_back(rule);
  }

  void addEmitters(const Scope& scope, OGRSpatialReferenceH earth) {
    OGRLayerH layer = addLayer(scope, "emitters", earth, wkbPoint,
                               {{"name", OFTString},
                                {"kind", OFTString},
                                {"platform", OFTString},
                                {"enabled", OFTInteger},
                                {"frequency_hz", OFTReal},
                                {"power_w", OFTReal},
                                {"height_msl_m", OFTReal},
                                {"time", OFTDateTime},
                                {"time_end", OFTDateTime},
                                {"color", OFTString}});
    for (const MapEmitter& emitter : emittersOf(study_)) {
      for (const MapPosition& at : emitter.positions) {
        NewFeature feature(layer);
        feature.set("name", emitter.emitter->name);
        feature.set("kind", scenario::toString(emitter.emitter->kind));
        feature.set("platform", emitter.platform);
        feature.setFlag("enabled", emitter.emitter->enabled);
        feature.set("frequency_hz", emitter.emitter->frequency_hz);
        feature.set("power_w", emitter.emitter->power_w);
        feature.set("height_msl_m", at.height_msl_m);
        feature.set("color", hexOf(pointColorOf(*emitter.emitter)));
        if (emitter.is_moving && study_.times_s.size() > 1) setTimes(feature, at.time_s);
        feature.setGeometry(pointAt(at.position));
        check(scope, feature.write());
      }
    }
  }

  void addSites(const Scope& scope, OGRSpatialReferenceH earth) {
    OGRLayerH layer = addLayer(scope, "sites", earth, wkbPoint,
                               {{"name", OFTString},
                                {"is_moving", OFTInteger},
                                {"emitters", OFTString},
                                {"receivers", OFTString},
                                {"targets", OFTString},
                                {"height_msl_m", OFTReal},
                                {"height_agl_m", OFTReal},
                                {"time", OFTDateTime},
                                {"time_end", OFTDateTime}});
    for (const MapSite& site : sitesOf(study_)) {
      for (const MapPosition& at : site.positions) {
        NewFeature feature(layer);
        feature.set("name", site.platform);
        feature.setFlag("is_moving", site.is_moving);
        feature.set("emitters", fmt::format("{}", fmt::join(site.emitters, ", ")));
        feature.set("receivers", fmt::format("{}", fmt::join(site.receivers, ", ")));
        feature.set("targets", fmt::format("{}", fmt::join(site.targets, ", ")));
        feature.set("height_msl_m", at.height_msl_m);
        const double ground_msl_m =
            study_.terrain == nullptr
                ? 0
                : study_.terrain->heightMsl_m(at.position.latitude_deg, at.position.longitude_deg);
        if (!std::isnan(ground_msl_m)) feature.set("height_agl_m", at.height_msl_m - ground_msl_m);
        if (site.is_moving) setTimes(feature, at.time_s);
        feature.setGeometry(pointAt(at.position));
        check(scope, feature.write());
      }
    }
  }

  void addTracks(const Scope& scope, OGRSpatialReferenceH earth) {
    OGRLayerH layer = addLayer(scope, "tracks", earth, wkbLineStringZM,
                               {{"platform", OFTString}, {"begin", OFTDateTime}, {"end", OFTDateTime}});
    std::vector<MapTrack> tracks;
    for (const MapTrack& track : tracksOf(study_)) {
      for (MapTrack& part : cutAtAntimeridian(track)) tracks.push_back(std::move(part));
    }
    for (const MapTrack& track : tracks) {
      NewFeature feature(layer);
      feature.set("platform", track.platform->name);
      feature.set("begin", utcOf(study_, track.positions.front().time_s));
      feature.set("end", utcOf(study_, track.positions.back().time_s));
      const gdal::Geometry line(OGR_G_CreateGeometry(wkbLineStringZM));
      for (const MapPosition& at : track.positions) {
        OGR_G_AddPointZM(line.get(), at.position.longitude_deg, at.position.latitude_deg, at.height_msl_m,
                         at.time_s);
      }
      feature.setGeometry(line);
      check(scope, feature.write());
    }
  }

  /// The table from which QGIS reads a layer's style.
  void addStyles(const Scope& scope) {
    OGRLayerH table = addLayer(scope, "layer_styles", nullptr, wkbNone,
                               {{"f_table_catalog", OFTString},
                                {"f_table_schema", OFTString},
                                {"f_table_name", OFTString},
                                {"f_geometry_column", OFTString},
                                {"styleName", OFTString},
                                {"styleQML", OFTString},
                                {"styleSLD", OFTString},
                                {"useAsDefault", OFTInteger},
                                {"description", OFTString},
                                {"owner", OFTString},
                                {"ui", OFTString},
                                {"update_time", OFTDateTime}});
    const std::pair<const char*, std::string> styles[] = {{"bands", bandStyle(band_rules_)},
                                                          {"contours", contourStyle(contour_rules_)},
                                                          {"emitters", emitterStyle()},
                                                          {"sites", siteStyle()},
                                                          {"tracks", trackStyle()}};
    for (const auto& [layer, qml] : styles) {
      NewFeature feature(table);
      for (const char* empty : {"f_table_catalog", "f_table_schema", "styleSLD", "owner", "ui"}) {
        feature.set(empty, "");
      }
      feature.set("f_table_name", layer);
      feature.set("f_geometry_column", "geom");
      feature.set("styleName", layer);
      feature.set("styleQML", qml);
      feature.setFlag("useAsDefault", true);
      feature.set("description", "emscape");
      feature.set("update_time", utcOf(study_, 0));
      check(scope, feature.write());
    }
  }

  UnfinishedFile file_;
  const MapStudy& study_;
  gdal::Dataset dataset_;
  OGRLayerH bands_ = nullptr, contours_ = nullptr;
  std::vector<StyleRule> band_rules_, contour_rules_;
};

}  // namespace

std::unique_ptr<MapCollection> makeGeoPackage(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<GeoPackage>(file, study);
}

}  // namespace emscape::study
