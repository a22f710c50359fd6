#include "study/sweep/measure.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {

std::vector<std::uint8_t> pixelsWithin(const std::string& file, const MapGrid& grid) {
  const scenario::GdalMessages messages;
  GDALAllRegister();
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, messages.explain(why.c_str()));
  };
  const Dataset polygons = openVectors(messages, file);
  const GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
      "", grid.width, grid.height, 1, GDT_Byte, nullptr));
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  raster->SetGeoTransform(transform);
  raster->SetProjection(grid.wkt.c_str());
  OGRSpatialReference map(grid.wkt.c_str());
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  std::vector<std::unique_ptr<OGRGeometry>> geometries;
  for (OGRLayer* layer : polygons->GetLayers()) {
    for (const OGRFeatureUniquePtr& feature : *layer) {
      const OGRGeometry* const geometry = feature->GetGeometryRef();
      if (geometry == nullptr || geometry->getDimension() != 2) continue;
      geometries.emplace_back(geometry->clone());
      if (layer->GetSpatialRef() != nullptr && geometries.back()->transformTo(&map) != OGRERR_NONE) {
        fail("a polygon cannot be brought to the map's projection");
      }
    }
  }
  if (geometries.empty()) fail("holds no polygon");
  std::vector<OGRGeometryH> handles;
  for (const auto& geometry : geometries) handles.push_back(OGRGeometry::ToHandle(geometry.get()));
  const int band = 1;
  const std::vector<double> ones(handles.size(), 1.0);
  std::vector<std::uint8_t> pixels(grid.pixels());
  if (GDALRasterizeGeometries(raster.get(), 1, &band, static_cast<int>(handles.size()), handles.data(),
                              nullptr, nullptr, ones.data(), nullptr, nullptr, nullptr) != CE_None ||
      raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.width, grid.height, pixels.data(), grid.width,
                                         grid.height, GDT_Byte, 0, 0, nullptr) != CE_None) {
    fail("cannot be drawn on the map");
  }
  if (std::find(pixels.begin(), pixels.end(), 1) == pixels.end()) fail("holds no pixel of the map");
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
