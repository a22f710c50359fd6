#include "study/maps/gdal_arrays.h"

#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

bool setText(const gdal::Attribute& attribute, const std::string& text) {
  return attribute != nullptr && GDALAttributeWriteString(attribute.get(), text.c_str()) != 0;
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
  return GDALMDArrayWrite(array.get(), start.data(), count.data(), nullptr, nullptr, type.get(), values,
                          nullptr, 0) != 0;
}

}  // namespace emscape::study
