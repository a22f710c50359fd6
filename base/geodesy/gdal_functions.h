/// The functions of GDAL that Emscape calls, as objects of the same names: the library is loaded at the first
/// call. An unqualified call within namespace emscape finds them before GDAL's own; a function that is
/// missing here fails to link.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <gdal_utils.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include "base/loaded_library.h"

namespace emscape {

namespace gdal {
/// @throws Error (other) if it cannot be loaded
const LoadedLibrary& library();
}  // namespace gdal

// clang-format off
#define EMSCAPE_GDAL_FUNCTIONS(F) \
  F(CPLCalloc) F(CPLCloseFileInZip) F(CPLCloseZip) F(CPLCreateFileInZip) F(CPLCreateZip) \
  F(CPLDestroyXMLNode) F(CPLError) F(CPLGetConfigOption) F(CPLGetErrorHandlerUserData) \
  F(CPLGetLastErrorMsg) F(CPLGetThreadLocalConfigOption) F(CPLGetXMLValue) F(CPLHTTPPopFetchCallback) F(CPLHTTPPushFetchCallback) \
  F(CPLParseXMLString) F(CPLPopErrorHandler) F(CPLPushErrorHandlerEx) F(CPLSetConfigOption) F(CPLSetThreadLocalConfigOption) \
  F(CPLStrdup) F(CPLWriteFileInZip) F(CSLDestroy) F(CSLTokenizeString2) F(GDALAddBand) F(GDALAllRegister) \
  F(GDALApproxTransform) F(GDALAttributeRelease) F(GDALAttributeWriteRaw) F(GDALAttributeWriteString) \
  F(GDALClose) F(GDALContourGenerateEx) F(GDALCreate) F(GDALCreateApproxTransformer) \
  F(GDALCreateColorTable) F(GDALCreateCopy) F(GDALCreateMultiDimensional) \
  F(GDALCreateRasterAttributeTable) F(GDALDataTypeIsComplex) F(GDALDatasetCommitTransaction) \
  F(GDALDatasetCreateLayer) F(GDALDatasetExecuteSQL) F(GDALDatasetGetLayer) F(GDALDatasetGetLayerCount) F(GDALDatasetGetRootGroup) \
  F(GDALDatasetRasterIO) F(GDALDatasetReleaseResultSet) F(GDALDatasetStartTransaction) F(GDALDestroyApproxTransformer) \
  F(GDALDestroyColorTable) F(GDALDestroyRasterAttributeTable) F(GDALDimensionGetName) \
  F(GDALDimensionGetSize) F(GDALDimensionRelease) F(GDALExtendedDataTypeCreate) \
  F(GDALExtendedDataTypeCreateString) F(GDALExtendedDataTypeGetSize) F(GDALExtendedDataTypeRelease) F(GDALGetBlockSize) F(GDALGetColorEntryAsRGB) F(GDALGetColorEntryCount) \
  F(GDALGetDataTypeName) F(GDALGetDataTypeSizeBytes) F(GDALGetDatasetDriver) F(GDALGetDriverByName) F(GDALGetDriverShortName) \
  F(GDALGetFileList) F(GDALGetGCPCount) F(GDALGetGeoTransform) F(GDALGetMaskBand) F(GDALGetMaskFlags) F(GDALGetMetadata) F(GDALGetDescription) F(GDALGetMetadataItem) \
  F(GDALGetRasterBand) F(GDALGetRasterColorTable) F(GDALGetRasterCount) F(GDALGetRasterDataType) F(GDALGetRasterNoDataValue) \
  F(GDALGetColorInterpretationName) F(GDALGetRasterColorInterpretation) F(GDALGetRasterOffset) \
  F(GDALGetRasterScale) F(GDALGetRasterUnitType) F(GDALGetRasterXSize) \
  F(GDALGetRasterYSize) F(GDALGetSpatialRef) F(GDALGroupCreateAttribute) F(GDALGroupCreateDimension) \
  F(GDALGroupCreateMDArray) F(GDALGroupOpenMDArray) F(GDALGroupRelease) F(GDALIdentifyDriverEx) F(GDALInvGeoTransform) \
  F(GDALMDArrayCreateAttribute) F(GDALMDArrayGetBlockSize) F(GDALMDArrayGetTotalElementsCount) F(GDALMDArrayRead) \
  F(GDALMDArrayRelease) F(GDALMDArraySetNoDataValueAsDouble) F(GDALMDArraySetRawNoDataValue) \
  F(GDALMDArraySetSpatialRef) F(GDALMDArraySetUnit) F(GDALMDArrayWrite) F(GDALOpenEx) F(GDALPolygonize) \
  F(GDALRATCreateColumn) F(GDALRATSetValueAsInt) F(GDALRATSetValueAsString) F(GDALRasterIO) \
  F(GDALSetColorEntry) F(GDALSetDefaultRAT) F(GDALSetDescription) F(GDALSetGeoTransform) \
  F(GDALSetMetadataItem) F(GDALSetProjection) F(GDALSetRasterCategoryNames) F(GDALSetRasterColorTable) \
  F(GDALSetRasterNoDataValue) F(GDALSetRasterUnitType) F(GDALWarp) F(GDALWarpAppOptionsFree) \
  F(GDALWarpAppOptionsNew) F(GDALWarpAppOptionsSetProgress) F(OCTDestroyCoordinateTransformation) F(OCTNewCoordinateTransformation) \
  F(OCTTransform) F(OCTTransformEx) F(OGR_FD_GetFieldCount) F(OGR_FD_GetFieldDefn) F(OGR_FD_GetFieldIndex) \
  F(OGR_FD_GetGeomFieldCount) F(OGR_FD_GetGeomFieldDefn) F(OGR_F_Create) F(OGR_F_Destroy) F(OGR_F_GetFID) \
  F(OGR_F_GetFieldAsDouble) F(OGR_F_GetFieldAsInteger) F(OGR_F_GetFieldAsString) F(OGR_F_GetFieldIndex) \
  F(OGR_F_GetGeometryRef) F(OGR_F_IsFieldSetAndNotNull) F(OGR_F_SetFieldDouble) F(OGR_F_SetFieldInteger) F(OGR_F_SetFieldString) \
  F(OGR_F_SetGeometry) F(OGR_F_StealGeometry) F(OGR_Fld_Create) F(OGR_Fld_Destroy) F(OGR_Fld_GetNameRef) \
  F(OGR_GFld_GetNameRef) F(OGR_G_AddGeometry) F(OGR_G_AddGeometryDirectly) F(OGR_G_AddPointZM) F(OGR_G_CreateGeometry) \
  F(OGR_G_DestroyGeometry) F(OGR_G_GetGeometryCount) F(OGR_G_GetGeometryRef) F(OGR_G_GetGeometryType) \
  F(OGR_G_GetLinearGeometry) F(OGR_G_GetPointCount) F(OGR_G_GetPoints) F(OGR_G_GetX) F(OGR_G_GetY) F(OGR_G_GetZ) \
  F(OGR_G_Intersection) F(OGR_G_IsEmpty) F(OGR_G_IsValid) F(OGR_G_MakeValid) F(OGR_G_SetPoint_2D) F(OGR_GT_Flatten) F(OGR_L_CreateFeature) F(OGR_L_CreateField) F(OGR_L_GetLayerDefn) F(OGR_L_GetName) \
  F(OGR_L_GetNextFeature) F(OGR_L_GetSpatialRef) F(OGR_L_ResetReading) F(OSRClone) F(OSRCloneGeogCS) \
  F(OSRDestroySpatialReference) F(OSRExportToWkt) F(OSRExportToWktEx) F(OSRGetAngularUnits) F(OSRGetAxis) \
  F(OSRGetAttrValue) F(OSRGetAuthorityCode) F(OSRGetAuthorityName) F(OSRGetAxesCount) \
  F(OSRGetLinearUnits) F(OSRGetName) F(OSRGetPROJSearchPaths) F(OSRGetTargetLinearUnits) F(OSRImportFromEPSG) F(OSRImportFromProj4) \
  F(OSRIsGeocentric) F(OSRIsGeographic) F(OSRIsSame) F(OSRIsProjected) F(OSRNewSpatialReference) \
  F(OSRSetAxisMappingStrategy) F(OSRSetPROJEnableNetwork) F(OSRSetWellKnownGeogCS) F(OSRStripVertical) F(VSIFCloseL) F(VSIFOpenL) F(VSIFReadL) \
  F(VSIFileFromMemBuffer) F(VSIFree) F(VSIReadDirRecursive) F(VSIStatExL) F(VSIStatL) F(VSIUnlink)
// clang-format on

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"  // such as those of allocators
#define EMSCAPE_DECLARE(name) inline const LoadedFunction<&gdal::library, decltype(::name)> name{#name};
EMSCAPE_GDAL_FUNCTIONS(EMSCAPE_DECLARE)
#undef EMSCAPE_DECLARE
#pragma GCC diagnostic pop
#undef EMSCAPE_GDAL_FUNCTIONS

}  // namespace emscape
