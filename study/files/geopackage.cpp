#include "study/files/geopackage.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>

#include "emscape/playback/scene.h"
#include "emscape/study/map_picture.h"
#include "render/annotate/overlay_parts.h"
#include "study/files/map_objects.h"
#include "study/files/map_shapes.h"
#include "study/files/qgis_style.h"
#include "study/maps/gdal_support.h"

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

std::string hexOf(const render::Rgb& color) {
  const auto level = [](float part) { return std::lround(255 * std::clamp(part, 0.0f, 1.0f)); };
  return fmt::format("#{:02x}{:02x}{:02x}", level(color.r), level(color.g), level(color.b));
}

class GeoPackage : public MapCollection {
 public:
  GeoPackage(const std::filesystem::path& file, const MapStudy& study) : file_(file), study_(study) {
    const Scope scope(*this);
    dataset_.reset(driverOf("GPKG")->Create(file_.temporary(), 0, 0, 0, GDT_Unknown, nullptr));
    check(scope, dataset_ != nullptr);
    dataset_->StartTransaction();
    const OGRSpatialReference map_reference = referenceOf(*study.grid), earth = wgs84Reference();
    bands_ = addLayer(scope, "bands", &map_reference, wkbMultiPolygon,
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
    contours_ = addLayer(scope, "contours", &map_reference, wkbLineString,
                         {{"product", OFTString},
                          {"height", OFTReal},
                          {"height_above", OFTString},
                          {"time", OFTDateTime},
                          {"time_end", OFTDateTime},
                          {"level", OFTReal},
                          {"unit", OFTString},
                          {"description", OFTString}});
    addEmitters(scope, earth);
    addSites(scope, earth);
    addTracks(scope, earth);
  }

  ~GeoPackage() override {
    const Scope scope(*this);
    dataset_.reset();
  }

  void add(const Map& map) override {
    const MapShapes shapes = shapesOf(*study_.grid, map, file_.file());
    const Scope scope(*this);
    for (const MapBand& band : shapes.bands) {
      const OGRFeatureUniquePtr feature = featureOf(bands_, map);
      feature->SetField("min", band.min);
      feature->SetField("max", band.max);
      feature->SetField("label", band.label.c_str());
      feature->SetField("color", band.color ? hexOf(*band.color).c_str() : "#00000000");
      feature->SetGeometry(band.geometry.get());
      check(scope, bands_->CreateFeature(feature.get()) == OGRERR_NONE);
    }
    for (const MapLine& line : shapes.lines) {
      const OGRFeatureUniquePtr feature = featureOf(contours_, map);
      feature->SetField("level", line.level);
      feature->SetGeometry(line.geometry.get());
      check(scope, contours_->CreateFeature(feature.get()) == OGRERR_NONE);
    }
    addRule(map);
  }

  void finish() override {
    {
      const Scope scope(*this);
      addStyles(scope);
      check(scope, dataset_->CommitTransaction() == OGRERR_NONE);
      dataset_.reset();
      check(scope, true);
    }
    file_.publish();
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

  OGRLayer* addLayer(const Scope& scope, const char* name, const OGRSpatialReference* reference,
                     OGRwkbGeometryType type, const std::vector<Field>& fields) {
    const char* const options[] = {"ASPATIAL_VARIANT=NOT_REGISTERED", nullptr};
    OGRLayer* const layer = dataset_->CreateLayer(name, const_cast<OGRSpatialReference*>(reference), type,
                                                  type == wkbNone ? const_cast<char**>(options) : nullptr);
    check(scope, layer != nullptr);
    for (const Field& field : fields) {
      const OGRFieldDefn definition(field.name, field.type);
      check(scope, layer->CreateField(const_cast<OGRFieldDefn*>(&definition)) == OGRERR_NONE);
    }
    return layer;
  }

  OGRFeatureUniquePtr featureOf(OGRLayer* layer, const Map& map) const {
    OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    feature->SetField("product", map.name.c_str());
    feature->SetField("unit", map.unit.c_str());
    feature->SetField("description", map.description.c_str());
    if (map.height) {
      feature->SetField("height", map.height->metres);
      feature->SetField("height_above", isAboveGround(map) ? "ground" : "mean sea level");
    }
    if (map.time_s) setTimes(*feature, *map.time_s);
    return feature;
  }
  static bool isAboveGround(const Map& map) {
    return map.height->reference == emfield::HeightReference::ground;
  }
  void setTimes(OGRFeature& feature, double time_s) const {
    feature.SetField("time", utcOf(study_, time_s).c_str());
    feature.SetField("time_end", utcOf(study_, endOf(study_, time_s)).c_str());
  }

  /// A rule of the style for a product at a height, over all times.
  void addRule(const Map& map) {
    StyleRule rule;
    rule.label = map.name;
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

  void addEmitters(const Scope& scope, const OGRSpatialReference& earth) {
    OGRLayer* const layer = addLayer(scope, "emitters", &earth, wkbPoint,
                                     {{"name", OFTString},
                                      {"kind", OFTString},
                                      {"platform", OFTString},
                                      {"frequency_hz", OFTReal},
                                      {"power_w", OFTReal},
                                      {"height_msl_m", OFTReal},
                                      {"time", OFTDateTime},
                                      {"time_end", OFTDateTime},
                                      {"color", OFTString}});
    for (const MapEmitter& emitter : emittersOf(study_)) {
      for (const MapPosition& at : emitter.positions) {
        const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
        feature->SetField("name", emitter.emitter->name.c_str());
        feature->SetField("kind", scenario::toString(emitter.emitter->kind));
        feature->SetField("platform", emitter.platform.c_str());
        feature->SetField("frequency_hz", emitter.emitter->frequency_hz);
        feature->SetField("power_w", emitter.emitter->power_w);
        feature->SetField("height_msl_m", at.height_msl_m);
        feature->SetField("color",
                          hexOf(render::colorOf(playback::markerKindOf(emitter.emitter->kind))).c_str());
        if (emitter.positions.size() > 1) setTimes(*feature, at.time_s);
        OGRPoint point(at.position.longitude_deg, at.position.latitude_deg);
        feature->SetGeometry(&point);
        check(scope, layer->CreateFeature(feature.get()) == OGRERR_NONE);
      }
    }
  }

  void addSites(const Scope& scope, const OGRSpatialReference& earth) {
    OGRLayer* const layer = addLayer(scope, "sites", &earth, wkbPoint,
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
        const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
        feature->SetField("name", site.platform.c_str());
        feature->SetField("is_moving", site.is_moving ? 1 : 0);
        feature->SetField("emitters", fmt::format("{}", fmt::join(site.emitters, ", ")).c_str());
        feature->SetField("receivers", fmt::format("{}", fmt::join(site.receivers, ", ")).c_str());
        feature->SetField("targets", fmt::format("{}", fmt::join(site.targets, ", ")).c_str());
        feature->SetField("height_msl_m", at.height_msl_m);
        const double ground_msl_m =
            study_.terrain == nullptr
                ? 0
                : study_.terrain->heightMsl_m(at.position.latitude_deg, at.position.longitude_deg);
        if (!std::isnan(ground_msl_m)) feature->SetField("height_agl_m", at.height_msl_m - ground_msl_m);
        if (site.is_moving) setTimes(*feature, at.time_s);
        OGRPoint point(at.position.longitude_deg, at.position.latitude_deg);
        feature->SetGeometry(&point);
        check(scope, layer->CreateFeature(feature.get()) == OGRERR_NONE);
      }
    }
  }

  void addTracks(const Scope& scope, const OGRSpatialReference& earth) {
    OGRLayer* const layer = addLayer(scope, "tracks", &earth, wkbLineStringZM,
                                     {{"platform", OFTString}, {"begin", OFTDateTime}, {"end", OFTDateTime}});
    for (const MapTrack& track : tracksOf(study_)) {
      const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
      feature->SetField("platform", track.platform.c_str());
      feature->SetField("begin", utcOf(study_, track.positions.front().time_s).c_str());
      feature->SetField("end", utcOf(study_, track.positions.back().time_s).c_str());
      OGRLineString line;
      for (const MapPosition& at : track.positions) {
        line.addPoint(at.position.longitude_deg, at.position.latitude_deg, at.height_msl_m, at.time_s);
      }
      feature->SetGeometry(&line);
      check(scope, layer->CreateFeature(feature.get()) == OGRERR_NONE);
    }
  }

  /// The table in which QGIS looks for a layer's style.
  void addStyles(const Scope& scope) {
    OGRLayer* const table = addLayer(scope, "layer_styles", nullptr, wkbNone,
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
      const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(table->GetLayerDefn()));
      for (const char* empty : {"f_table_catalog", "f_table_schema", "styleSLD", "owner", "ui"}) {
        feature->SetField(empty, "");
      }
      feature->SetField("f_table_name", layer);
      feature->SetField("f_geometry_column", "geom");
      feature->SetField("styleName", layer);
      feature->SetField("styleQML", qml.c_str());
      feature->SetField("useAsDefault", 1);
      feature->SetField("description", "emscape");
      feature->SetField("update_time", utcOf(study_, 0).c_str());
      check(scope, table->CreateFeature(feature.get()) == OGRERR_NONE);
    }
  }

  UnfinishedFile file_;
  const MapStudy& study_;
  Dataset dataset_;
  OGRLayer *bands_ = nullptr, *contours_ = nullptr;
  std::vector<StyleRule> band_rules_, contour_rules_;
};

}  // namespace

std::unique_ptr<MapCollection> makeGeoPackage(const std::filesystem::path& file, const MapStudy& study) {
  return std::make_unique<GeoPackage>(file, study);
}

}  // namespace emscape::study
