#include "study/sweep/measure.h"

#include <gdal_alg.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "scenario/terrain/transformation.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {

std::vector<std::uint8_t> pixelsWithin(const std::string& file, const MapGrid& grid) {
  const scenario::GdalMessages messages;
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, messages.explain(why.c_str()));
  };
  const gdal::Dataset polygons = openVectors(messages, file);
  const gdal::Dataset raster = memoryRaster(grid, GDT_Byte, file);
  const gdal::SpatialReference map = referenceOf(grid);
  std::vector<gdal::Geometry> geometries;
  for (int n = 0; n < GDALDatasetGetLayerCount(polygons.get()); ++n) {
    OGRLayerH layer = GDALDatasetGetLayer(polygons.get(), n);
    gdal::Transformation to_map;
    if (OGR_L_GetSpatialRef(layer) != nullptr) {
      to_map = scenario::newTransformation(OGR_L_GetSpatialRef(layer), map.get());
      if (to_map == nullptr) fail("its polygons cannot be brought to the map's projection");
    }
    OGR_L_ResetReading(layer);
    while (const gdal::Feature feature{OGR_L_GetNextFeature(layer)}) {
      OGRGeometryH geometry = OGR_F_GetGeometryRef(feature.get());
      if (geometry == nullptr || OGR_G_GetDimension(geometry) != 2) continue;
      geometries.emplace_back(OGR_G_Clone(geometry));
      if (to_map != nullptr && OGR_G_Transform(geometries.back().get(), to_map.get()) != OGRERR_NONE) {
        fail("a polygon cannot be brought to the map's projection");
      }
    }
  }
  if (geometries.empty()) fail("has no polygon");
  std::vector<OGRGeometryH> handles;
  for (const gdal::Geometry& geometry : geometries) handles.push_back(geometry.get());
  const int band = 1;
  const std::vector<double> ones(handles.size(), 1.0);
  std::vector<std::uint8_t> pixels(grid.pixels());
  if (GDALRasterizeGeometries(raster.get(), 1, &band, static_cast<int>(handles.size()), handles.data(),
                              nullptr, nullptr, ones.data(), nullptr, nullptr, nullptr) != CE_None ||
      GDALRasterIO(GDALGetRasterBand(raster.get(), 1), GF_Read, 0, 0, grid.width, grid.height, pixels.data(),
                   grid.width, grid.height, GDT_Byte, 0, 0) != CE_None) {
    fail("cannot be drawn on the map");
  }
  if (std::find(pixels.begin(), pixels.end(), 1) == pixels.end()) fail("has no pixel of the map");
  return pixels;
}

void MeasureOverTime::add(const StudyMeasure& measure, const CoverageMap& map, const MapGrid& grid,
                          const std::vector<std::uint8_t>& pixels) {
  using Figure = StudyMeasure::Figure;
  const auto area_class = static_cast<float>(info(measure.product).area_class);
  double known_m2 = 0, of_class_m2 = 0, integral = 0, min = HUGE_VAL, max = -HUGE_VAL;
  const bool is_of_area = measure.figure == Figure::km2 || measure.figure == Figure::percent;
  const bool is_told = is_of_area && pixels.empty();  // by the map
  if (is_told) {
    known_m2 = map.known_area_m2;
    of_class_m2 = map.class_area_m2;
  }
  for (std::size_t p = 0; p < map.values.size() && !is_told; ++p) {
    const float value = map.values[p];
    if (std::isnan(value) || (!pixels.empty() && pixels[p] == 0)) continue;
    const auto area_m2 = static_cast<double>(grid.areas_m2[p]);
    known_m2 += area_m2;
    if (value == area_class) of_class_m2 += area_m2;
    integral += static_cast<double>(value) * area_m2;
    min = std::min(min, static_cast<double>(value));
    max = std::max(max, static_cast<double>(value));
  }
  if (measure.figure == Figure::km2) {
    sum_ += of_class_m2 / 1e6;
  } else if (known_m2 == 0) {
    return;
  } else {
    sum_ += measure.figure == Figure::percent ? 100 * of_class_m2 / known_m2 : integral / known_m2;
  }
  min_ = std::min(min_, min);
  max_ = std::max(max_, max);
  ++count_;
}

double MeasureOverTime::value(const StudyMeasure& measure) const {
  if (count_ == 0) return NAN;
  if (measure.figure == StudyMeasure::Figure::min) return min_;
  if (measure.figure == StudyMeasure::Figure::max) return max_;
  return sum_ / count_;
}

}  // namespace emscape::study
