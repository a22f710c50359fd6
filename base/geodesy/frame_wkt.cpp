#include <fmt/core.h>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"

namespace emscape {
namespace {

constexpr const char* kDegree = R"_(ANGLEUNIT["degree",0.0174532925199433])_";
constexpr const char* kMetre = R"_(LENGTHUNIT["metre",1])_";

std::string parameter(const char* name, double value, const char* unit, int epsg) {
  return fmt::format(R"_(PARAMETER["{}",{},{},ID["EPSG",{}]])_", name, value, unit, epsg);
}

/// @param keyword  BASEGEOGCRS or BASEGEODCRS
std::string wgs84(const char* keyword, int epsg) {
  return fmt::format(
      R"_({}["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,{}]],)_"
      R"_(PRIMEM["Greenwich",0,{}],ID["EPSG",{}]])_",
      keyword, kMetre, kDegree, epsg);
}

std::string altitudeWkt(const FrameOrigin& frame) {
  const std::string plane = fmt::format(
      R"_(PROJCRS["Azimuthal equidistant about the origin of the region",{},)_"
      R"_(CONVERSION["Azimuthal equidistant",METHOD["Modified Azimuthal Equidistant",ID["EPSG",9832]],{},{},{},{}],)_"
      R"_(CS[Cartesian,2],AXIS["(E)",east,ORDER[1],{}],AXIS["(N)",north,ORDER[2],{}]])_",
      wgs84("BASEGEOGCRS", 4326), parameter("Latitude of natural origin", frame.latitude_deg, kDegree, 8801),
      parameter("Longitude of natural origin", frame.longitude_deg, kDegree, 8802),
      parameter("False easting", 0, kMetre, 8806), parameter("False northing", 0, kMetre, 8807), kMetre,
      kMetre);
  return fmt::format(
      R"_(COMPOUNDCRS["Region, heights above EGM96",{},VERTCRS["EGM96 height",VDATUM["EGM96 geoid"],)_"
      R"_(CS[vertical,1],AXIS["gravity-related height (H)",up,{}],ID["EPSG",5773]]])_",
      plane, kMetre);
}

std::string enuWkt(const FrameOrigin& frame) {
  const double height_m = frame.height_msl_m + geoidUndulation_m(frame.latitude_deg, frame.longitude_deg);
  return fmt::format(
      R"_(GEODCRS["East, north, up at the origin of the region",{},)_"
      R"_(DERIVINGCONVERSION["Topocentric",METHOD["Geographic/topocentric conversions",ID["EPSG",9837]],{},{},{}],)_"
      R"_(CS[Cartesian,3],AXIS["topocentric east (U)",east,ORDER[1],{}],)_"
      R"_(AXIS["topocentric north (V)",north,ORDER[2],{}],AXIS["topocentric up (W)",up,ORDER[3],{}]])_",
      wgs84("BASEGEODCRS", 4979),
      parameter("Latitude of topocentric origin", frame.latitude_deg, kDegree, 8834),
      parameter("Longitude of topocentric origin", frame.longitude_deg, kDegree, 8835),
      parameter("Ellipsoidal height of topocentric origin", height_m, kMetre, 8836), kMetre, kMetre, kMetre);
}

}  // namespace

std::string wktOf(const FrameOrigin& frame) {
  GeoFrame checked(frame);  // throws
  return frame.kind == FrameKind::enu ? enuWkt(frame) : altitudeWkt(frame);
}

}  // namespace emscape
