/// GDAL's multidimensional arrays, for the writers of netCDF files.
#pragma once

#include <string>
#include <vector>

#include "base/geodesy/gdal.h"

namespace emscape::study {

using ArrayDimensions = std::vector<GDALDimensionH>;

gdal::ValueType numberType(GDALDataType type);
gdal::ValueType textType();

/// A file in memory, or on disk, open until it is released. @return null if it cannot be created
/// @param options  ended by a null pointer
gdal::Dataset createArrayFile(const std::string& file, const char* const* options);
gdal::Group rootOf(const gdal::Dataset& dataset);

/// @param type  one of GDAL_DIM_TYPE_...; empty: none. @return null if it cannot be created
gdal::Dimension addDimension(const gdal::Group& group, const std::string& name, const char* type,
                             std::size_t size);
/// @param options  ended by a null pointer, or null. @return null if it cannot be created
gdal::Array addArray(const gdal::Group& group, const std::string& name, const ArrayDimensions& dimensions,
                     const gdal::ValueType& type, const char* const* options = nullptr);

/// An attribute of a file or of an array. @return false if it cannot be written
bool setText(const gdal::Group& group, const char* name, const std::string& text);
bool setText(const gdal::Array& array, const char* name, const std::string& text);

/// Row of blocks by row of blocks, with checkpoints.
/// @param start,count  of the written part, along the array's dimensions
/// @return false if it cannot be written
/// @throws Stopped
bool writeArray(const gdal::Array& array, const std::vector<GUInt64>& start,
                const std::vector<std::size_t>& count, const gdal::ValueType& type, const void* values);

}  // namespace emscape::study
