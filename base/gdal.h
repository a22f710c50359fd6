/// Owners of GDAL's objects. Emscape calls GDAL by its C functions alone: they are the same in every GDAL 3,
/// while the C++ classes differ from version to version.
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
/// Owns what a function of GDAL releases.
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

// Of netCDF files.
using Group = Owned<GDALGroupRelease>;
using Dimension = Owned<GDALDimensionRelease>;
using Array = Owned<GDALMDArrayRelease>;
using Attribute = Owned<GDALAttributeRelease>;
using ValueType = Owned<GDALExtendedDataTypeRelease>;

}  // namespace emscape::gdal
