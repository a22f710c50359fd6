#include "scenario/terrain/transformation.h"

#include <cstdlib>
#include <cstring>

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

}  // namespace emscape::scenario
