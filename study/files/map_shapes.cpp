#include "study/files/map_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "study/maps/gdal_support.h"
#include "study/picture/map_colors.h"

namespace emscape::study {
namespace {

constexpr double kMaxLevels = 64;

double logOddsOf(double probability) {
  constexpr double kMinProbability = 1e-6;
  const double clamped = std::clamp(probability, kMinProbability, 1 - kMinProbability);
  return std::log(clamped / (1 - clamped));
}

/// 1, 2, 2.5 or 5 times a power of ten, not less than a step.
double roundStep(double step) {
  const double power = std::pow(10, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

struct Range {
  double min = INFINITY, max = -INFINITY;
};
Range rangeOf(const Map& map) {
  Range range;
  for (const float value : map.values) {
    if (std::isnan(value)) continue;
    range.min = std::min(range.min, static_cast<double>(value));
    range.max = std::max(range.max, static_cast<double>(value));
  }
  return range;
}

/// A layer in memory that GDAL's algorithms fill.
class Layer {
 public:
  explicit Layer(const std::filesystem::path& file)
      : dataset_(GDALCreate(driverOf("Memory"), "", 0, 0, 0, GDT_Unknown, nullptr)), file_(file) {
    if (dataset_ != nullptr) {
      layer_ = GDALDatasetCreateLayer(dataset_.get(), "shapes", nullptr, wkbUnknown, nullptr);
    }
    if (layer_ == nullptr) failWriting(messages_, file);
  }
  int addField(const char* name, OGRFieldType type) {
    const gdal::FieldDefinition field(OGR_Fld_Create(name, type));
    OGR_L_CreateField(layer_, field.get(), TRUE);
    return OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer_), name);
  }
  void check(CPLErr result) const {
    if (result != CE_None || messages_.hasFailure()) failWriting(messages_, file_);
  }
  OGRLayerH get() const { return layer_; }
  /// The features from the first on.
  void rewind() const { OGR_L_ResetReading(layer_); }
  gdal::Feature next() const { return gdal::Feature(OGR_L_GetNextFeature(layer_)); }

 private:
  scenario::GdalMessages messages_;
  gdal::Dataset dataset_;
  std::filesystem::path file_;
  OGRLayerH layer_ = nullptr;
};

/// Adds the polygons of a geometry, without its lines and points, to a multipolygon.
void addPolygons(OGRGeometryH geometry, OGRGeometryH polygons) {
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
  if (type == wkbPolygon) {
    OGR_G_AddGeometry(polygons, geometry);
  } else if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
    for (int n = 0; n < OGR_G_GetGeometryCount(geometry); ++n)
      addPolygons(OGR_G_GetGeometryRef(geometry, n), polygons);
  }
}

/// Rings that touch themselves, as GDAL makes them around pixels without a value, are split.
gdal::Geometry validPolygons(gdal::Geometry geometry) {
  const scenario::GdalMessages quiet;  // GEOS tells where a ring touches itself
  if (OGR_G_IsValid(geometry.get()) != 0) return geometry;
  const gdal::Geometry valid(OGR_G_MakeValid(geometry.get()));
  if (valid == nullptr) return geometry;
  gdal::Geometry polygons(OGR_G_CreateGeometry(wkbMultiPolygon));
  addPolygons(valid.get(), polygons.get());
  return polygons;
}

/// The outlines of the pixels of each number other than `none`, as multipolygons.
std::map<int, gdal::Geometry> outlinesOf(const MapGrid& grid, std::vector<std::int32_t> numbers, int none,
                                         const std::filesystem::path& file) {
  const gdal::Dataset raster = memoryRaster(grid, GDT_Int32, file);
  GDALRasterBandH band = GDALGetRasterBand(raster.get(), 1);
  Layer outlines(file);
  const int field = outlines.addField("value", OFTInteger);
  outlines.check(GDALRasterIO(band, GF_Write, 0, 0, grid.width, grid.height, numbers.data(), grid.width,
                              grid.height, GDT_Int32, 0, 0));
  outlines.check(GDALPolygonize(band, nullptr, outlines.get(), field, nullptr, goesOn, nullptr));
  std::map<int, gdal::Geometry> by_number;
  outlines.rewind();
  while (const gdal::Feature feature = outlines.next()) {
    const int number = OGR_F_GetFieldAsInteger(feature.get(), field);
    if (number == none) continue;
    gdal::Geometry& all = by_number[number];
    if (all == nullptr) all.reset(OGR_G_CreateGeometry(wkbMultiPolygon));
    OGR_G_AddGeometryDirectly(all.get(), OGR_F_StealGeometry(feature.get()));
  }
  return by_number;
}

/// Adds the band of the pixels with a probability of 0.
void addZeros(const MapGrid& grid, const Map& map, const std::filesystem::path& file, MapShapes& shapes) {
  std::vector<std::int32_t> is_zero(map.values.size());
  for (std::size_t p = 0; p < is_zero.size(); ++p) is_zero[p] = map.values[p] == 0 ? 1 : 0;
  std::map<int, gdal::Geometry> zeros = outlinesOf(grid, std::move(is_zero), 0, file);
  if (zeros.empty()) return;
  MapBand band;
  band.geometry = validPolygons(std::move(zeros.begin()->second));
  shapes.bands.insert(shapes.bands.begin(), std::move(band));
}

void addContours(const MapGrid& grid, const Map& map, const std::filesystem::path& file, MapShapes& shapes) {
  const std::vector<double> levels = levelsOf(map);
  const bool by_log_odds = map.kind == MapKind::probability;
  const auto scaled = [&](double value) { return by_log_odds ? logOddsOf(value) : value; };
  const bool has_zeros = by_log_odds && !levels.empty();
  const gdal::Dataset raster = memoryRaster(grid, GDT_Float64, file);
  GDALRasterBandH band = GDALGetRasterBand(raster.get(), 1);
  std::vector<double> values(map.values.size(), NAN);
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (!std::isnan(map.values[p]) && !(has_zeros && map.values[p] == 0))
      values[p] = scaled(static_cast<double>(map.values[p]));
  }
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
    return addZeros(grid, map, file, shapes);
  Layer lines(file), bands(file);
  lines.check(GDALRasterIO(band, GF_Write, 0, 0, grid.width, grid.height, values.data(), grid.width,
                           grid.height, GDT_Float64, 0, 0));
  std::string fixed = "FIXED_LEVELS=";
  for (const double level : levels) {
    fixed += fmt::format("{}{:.17g}", fixed.back() == '=' ? "" : ",", scaled(level));
  }
  const auto nearestLevel = [&](double value) {
    std::size_t nearest = 0;
    for (std::size_t n = 1; n < levels.size(); ++n) {
      if (std::abs(scaled(levels[n]) - value) < std::abs(scaled(levels[nearest]) - value)) nearest = n;
    }
    return nearest;
  };
  const int level_field = lines.addField("level", OFTReal), max_field = bands.addField("max", OFTReal);
  if (!levels.empty()) {
    const std::string field = fmt::format("ELEV_FIELD={}", level_field);
    const char* const options[] = {fixed.c_str(), field.c_str(), "NODATA=nan", nullptr};
    lines.check(GDALContourGenerateEx(band, lines.get(), options, goesOn, nullptr));
    lines.rewind();
    while (const gdal::Feature feature = lines.next()) {
      const double level = levels[nearestLevel(OGR_F_GetFieldAsDouble(feature.get(), level_field))];
      shapes.lines.push_back({level, gdal::Geometry(OGR_F_StealGeometry(feature.get()))});
    }
    std::stable_sort(shapes.lines.begin(), shapes.lines.end(),
                     [](const MapLine& a, const MapLine& b) { return a.level < b.level; });
  } else {
    fixed += "1e300";  // one band for all values
  }
  const std::string field = fmt::format("ELEV_FIELD_MAX={}", max_field);
  const char* const options[] = {fixed.c_str(), field.c_str(), "POLYGONIZE=YES", "NODATA=nan", nullptr};
  bands.check(GDALContourGenerateEx(band, bands.get(), options, goesOn, nullptr));
  const Range range = rangeOf(map);
  const render::Legend legend = legendOf(map);
  bands.rewind();
  while (const gdal::Feature feature = bands.next()) {
    // GDAL 3.6 sets no limit for the bands below the first and above the last level.
    const double max = OGR_F_GetFieldAsDouble(feature.get(), max_field);
    const bool is_last = levels.empty() || max > scaled(levels.back()) + 1e-6;
    const std::size_t above = is_last ? levels.size() : nearestLevel(max);
    MapBand one;
    one.min = above == 0 ? std::min(range.min, is_last ? range.max : levels[above]) : levels[above - 1];
    one.max = is_last ? range.max : levels[above];
    one.geometry.reset(OGR_F_StealGeometry(feature.get()));
    if (one.geometry == nullptr || OGR_G_IsEmpty(one.geometry.get())) continue;
    one.geometry = validPolygons(std::move(one.geometry));
    const bool is_nothing = isFraction(map.kind) && above == 0 && !is_last;
    if (!is_nothing) one.color = colorOf(map, legend, static_cast<float>((one.min + one.max) / 2));
    shapes.bands.push_back(std::move(one));
  }
  std::stable_sort(shapes.bands.begin(), shapes.bands.end(),
                   [](const MapBand& a, const MapBand& b) { return a.max < b.max; });
  if (has_zeros) addZeros(grid, map, file, shapes);
}

void addOutlines(const MapGrid& grid, const Map& map, const std::filesystem::path& file, MapShapes& shapes) {
  constexpr int kNone = -1;
  const int nothing = map.kind == MapKind::classes ? 0 : -1;
  std::vector<std::int32_t> numbers(map.values.size(), kNone);
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    const float value = map.values[p];
    if (!std::isnan(value) && static_cast<int>(value) != nothing) numbers[p] = static_cast<int>(value);
  }
  std::map<int, gdal::Geometry> by_number = outlinesOf(grid, std::move(numbers), kNone, file);
  const render::Legend legend = legendOf(map);
  for (auto& [number, outline] : by_number) {
    MapBand one;
    one.min = one.max = number;
    one.color = colorOf(map, legend, static_cast<float>(number));
    if (number < static_cast<int>(map.labels.size())) one.label = map.labels[number];
    one.geometry = validPolygons(std::move(outline));
    shapes.bands.push_back(std::move(one));
  }
}

}  // namespace

std::vector<double> levelsOf(const Map& map) {
  if (isWhole(map.kind)) return {};
  const Range range = rangeOf(map);
  if (isFraction(map.kind) && range.max <= 1) return {0.1, 0.5, 0.9};
  if (!(range.min < range.max)) return {};
  double step = map.unit.rfind("dB", 0) == 0 ? 10 : roundStep((range.max - range.min) / 4);
  if ((range.max - range.min) / step > kMaxLevels) step = roundStep((range.max - range.min) / kMaxLevels);
  std::vector<double> levels;
  for (double n = std::floor(range.min / step) + 1; n * step < range.max; ++n) levels.push_back(n * step);
  return levels;
}

MapShapes shapesOf(const MapGrid& grid, const Map& map, const std::filesystem::path& file) {
  MapShapes shapes;
  if (rangeOf(map).min > rangeOf(map).max) return shapes;  // no value anywhere
  if (isWhole(map.kind)) {
    addOutlines(grid, map, file, shapes);
  } else {
    addContours(grid, map, file, shapes);
  }
  return shapes;
}

}  // namespace emscape::study
