#include "scenario/terrain/transformation.h"

#include <cstdlib>
#include <cstring>

#include "emscape/base/error.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

bool areOfOneKind(OGRSpatialReferenceH a, OGRSpatialReferenceH b) {
  return OSRIsGeographic(a) == OSRIsGeographic(b) && OSRIsProjected(a) == OSRIsProjected(b);
}

/// PROJ looks up a system by the EPSG code that it carries, and crashes if that is a geocentric one in place
/// of a geographic one (9.1, with the codes of withdrawn systems in GeoTIFFs).
bool carriesCodeOfAnotherKind(OGRSpatialReferenceH system) {
  const char* const authority = OSRGetAuthorityName(system, nullptr);
  const char* const code = OSRGetAuthorityCode(system, nullptr);
  if (authority == nullptr || code == nullptr || std::strcmp(authority, "EPSG") != 0) return false;
  const gdal::SpatialReference coded(OSRNewSpatialReference(nullptr));
  if (OSRImportFromEPSG(coded.get(), std::atoi(code)) != OGRERR_NONE || areOfOneKind(system, coded.get()))
    return false;
  CPLError(CE_Failure, CPLE_AppDefined, "it carries the code EPSG:%s, which is of another kind of system",
           code);
  return true;
}

bool hasSoundCodes(OGRSpatialReferenceH system) {
  if (carriesCodeOfAnotherKind(system)) return false;
  const gdal::SpatialReference base(OSRIsProjected(system) ? OSRCloneGeogCS(system) : nullptr);
  return base == nullptr || !carriesCodeOfAnotherKind(base.get());
}

}  // namespace

gdal::Transformation newTransformation(OGRSpatialReferenceH from, OGRSpatialReferenceH to) {
  if (!hasSoundCodes(from) || !hasSoundCodes(to)) return nullptr;
  return gdal::Transformation(OCTNewCoordinateTransformation(from, to));
}

gdal::SpatialReference wgs84Reference() {
  const GdalMessages messages;
  gdal::SpatialReference reference(OSRNewSpatialReference(nullptr));
  if (OSRImportFromEPSG(reference.get(), 4326) != OGRERR_NONE)
    throw Error(ErrorCode::other, messages.explain("PROJ does not know EPSG:4326, longitude and latitude"));
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

gdal::Transformation transformationBetween(const gdal::SpatialReference& from,
                                           const gdal::SpatialReference& to) {
  const GdalMessages messages;
  gdal::Transformation transformation = newTransformation(from.get(), to.get());
  if (transformation == nullptr) {
    throw Error(ErrorCode::other, messages.explain("PROJ cannot transform between the coordinate systems"));
  }
  return transformation;
}

}  // namespace emscape::scenario
