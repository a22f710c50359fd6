/// Owners of GDAL objects. Emscape uses only GDAL's C functions: they are the same in every GDAL 3, while the
/// C++ classes differ between versions.
#pragma once

#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <memory>
#include <type_traits>

namespace emscape::gdal {

template <auto* kRelease>
struct Release;
template <class Result, class Handle, Result (*kRelease)(Handle)>
struct Release<kRelease> {
  using pointer = Handle;
  void operator()(Handle object) const { kRelease(object); }
};
/// Owns an object that is released by a GDAL function.
template <auto* kRelease>
using Owned = std::unique_ptr<std::remove_pointer_t<typename Release<kRelease>::pointer>, Release<kRelease>>;

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
