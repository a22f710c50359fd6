/// Owners of GDAL objects. Emscape uses only GDAL's C functions: they are the same in every GDAL 3, while the
/// C++ classes differ between versions.
#pragma once

#include <memory>
#include <type_traits>

#include "base/geodesy/gdal_functions.h"

namespace emscape::gdal {

/// Releases an object by a function of GDAL.
template <const auto& kFunction>
struct Release {
  using pointer = typename std::remove_reference_t<decltype(kFunction)>::FirstArgument;
  void operator()(pointer object) const { kFunction(object); }
};
/// Owns an object that is released by a function of GDAL.
template <const auto& kFunction>
using Owned =
    std::unique_ptr<std::remove_pointer_t<typename Release<kFunction>::pointer>, Release<kFunction>>;

using Dataset = Owned<GDALClose>;
using SpatialReference = Owned<OSRDestroySpatialReference>;
using Transformation = Owned<OCTDestroyCoordinateTransformation>;
using Feature = Owned<OGR_F_Destroy>;
using FieldDefinition = Owned<OGR_Fld_Destroy>;
using Geometry = Owned<OGR_G_DestroyGeometry>;
using ColorTable = Owned<GDALDestroyColorTable>;
using AttributeTable = Owned<GDALDestroyRasterAttributeTable>;

// For netCDF files.
using Group = Owned<GDALGroupRelease>;
using Dimension = Owned<GDALDimensionRelease>;
using Array = Owned<GDALMDArrayRelease>;
using Attribute = Owned<GDALAttributeRelease>;
using ValueType = Owned<GDALExtendedDataTypeRelease>;

}  // namespace emscape::gdal
