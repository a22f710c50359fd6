#include "study/maps/gdal_arrays.h"

#include <algorithm>

#include "emscape/base/work.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

bool setText(const gdal::Attribute& attribute, const std::string& text) {
  return attribute != nullptr && GDALAttributeWriteString(attribute.get(), text.c_str()) != 0;
}

bool writePart(const gdal::Array& array, const std::vector<GUInt64>& start,
               const std::vector<std::size_t>& count, const gdal::ValueType& type, const void* values) {
  return GDALMDArrayWrite(array.get(), start.data(), count.data(), nullptr, nullptr, type.get(), values,
                          nullptr, 0) != 0;
}

/// The first dimension along which there is more than one value; count.size(): none.
std::size_t splitDimension(const std::vector<std::size_t>& count) {
  const auto found = std::find_if(count.begin(), count.end(), [](std::size_t n) { return n > 1; });
  return static_cast<std::size_t>(found - count.begin());
}

/// Values of an array's blocks, which are compressed when they are complete, along a dimension; 0: it has
/// none.
std::size_t blockSize(const gdal::Array& array, std::size_t dimension) {
  std::size_t dimensions = 0;
  GUInt64* const sizes = GDALMDArrayGetBlockSize(array.get(), &dimensions);
  const GUInt64 size = sizes != nullptr && dimension < dimensions ? sizes[dimension] : 0;
  VSIFree(sizes);
  return static_cast<std::size_t>(size);
}

}  // namespace

gdal::ValueType numberType(GDALDataType type) {
  return gdal::ValueType(GDALExtendedDataTypeCreate(type));
}

gdal::ValueType textType() {
  return gdal::ValueType(GDALExtendedDataTypeCreateString(0));
}

gdal::Dataset createArrayFile(const std::string& file, const char* const* options) {
  return gdal::Dataset(GDALCreateMultiDimensional(driverOf("netCDF"), file.c_str(), nullptr, options));
}

gdal::Group rootOf(const gdal::Dataset& dataset) {
  return gdal::Group(dataset == nullptr ? nullptr : GDALDatasetGetRootGroup(dataset.get()));
}

gdal::Dimension addDimension(const gdal::Group& group, const std::string& name, const char* type,
                             std::size_t size) {
  return gdal::Dimension(GDALGroupCreateDimension(group.get(), name.c_str(), type, "", size, nullptr));
}

gdal::Array addArray(const gdal::Group& group, const std::string& name, const ArrayDimensions& dimensions,
                     const gdal::ValueType& type, const char* const* options) {
  ArrayDimensions handles = dimensions;  // GDAL takes them without const
  return gdal::Array(
      GDALGroupCreateMDArray(group.get(), name.c_str(), handles.size(), handles.data(), type.get(), options));
}

bool setText(const gdal::Group& group, const char* name, const std::string& text) {
  return setText(
      gdal::Attribute(GDALGroupCreateAttribute(group.get(), name, 0, nullptr, textType().get(), nullptr)),
      text);
}

bool setText(const gdal::Array& array, const char* name, const std::string& text) {
  return setText(
      gdal::Attribute(GDALMDArrayCreateAttribute(array.get(), name, 0, nullptr, textType().get(), nullptr)),
      text);
}

bool writeArray(const gdal::Array& array, const std::vector<GUInt64>& start,
                const std::vector<std::size_t>& count, const gdal::ValueType& type, const void* values) {
  const std::size_t split = splitDimension(count);
  const std::size_t at_once = blockSize(array, split);
  if (at_once == 0 || split == count.size()) return writePart(array, start, count, type, values);
  std::size_t slice_bytes = GDALExtendedDataTypeGetSize(type.get());
  for (std::size_t n = split + 1; n < count.size(); ++n) slice_bytes *= count[n];
  std::vector<GUInt64> part_start = start;
  std::vector<std::size_t> part_count = count;
  for (std::size_t begin = 0; begin < count[split]; begin += at_once) {
    checkpoint();
    part_start[split] = start[split] + begin;
    part_count[split] = std::min(at_once, count[split] - begin);
    if (!writePart(array, part_start, part_count, type,
                   static_cast<const char*>(values) + begin * slice_bytes))
      return false;
  }
  return true;
}

}  // namespace emscape::study
