/// Files of points and polygons in GDAL's formats.
#pragma once

#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <string>

#include "base/geodesy/gdal.h"

namespace emscape::test {

/// Writes the features of a GeoJSON file in another format.
inline void convertVectors(const std::string& geojson, const std::string& driver, const std::string& file) {
  GDALAllRegister();
  GDALDatasetH source = GDALOpenEx(geojson.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
  std::string format = "-f", name = driver;
  char* arguments[] = {format.data(), name.data(), nullptr};
  GDALVectorTranslateOptions* const options = GDALVectorTranslateOptionsNew(arguments, nullptr);
  const gdal::Dataset made(GDALVectorTranslate(file.c_str(), nullptr, 1, &source, options, nullptr));
  EXPECT_NE(made, nullptr) << driver;
  GDALVectorTranslateOptionsFree(options);
  GDALClose(source);
}

}  // namespace emscape::test
