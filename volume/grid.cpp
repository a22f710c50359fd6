#include "emscape/volume/grid.h"

namespace emscape::volume {

std::vector<std::pair<std::string, std::string>> standardWords(bool georeferenced, const FrameOrigin& frame) {
  std::vector<std::pair<std::string, std::string>> words;
  if (georeferenced) {
    const bool above_sea = frame.kind == FrameKind::altitude;
    words = {{"crs_wkt", wktOf(frame)},
             {"vertical_datum", above_sea ? "EGM96 (EPSG:5773)" : "WGS84 ellipsoid (EPSG:4979)"},
             {"axes", above_sea ? "x east, y north, z up from mean sea level"
                                : "x east, y north, z up from the origin"}};
  }
  words.emplace_back("length_unit", "m");
  words.emplace_back(
      "no_value",
      "masked voxels: below the ground or without a known field; 'floor' is a value: a field of "
      "at most this");
  return words;
}

bool operator==(const Grid& a, const Grid& b) {
  if (a.dims != b.dims || a.spacing_m != b.spacing_m || a.first_center_m != b.first_center_m ||
      a.georeferenced != b.georeferenced) {
    return false;
  }
  return !a.georeferenced ||
         (a.frame.kind == b.frame.kind && a.frame.latitude_deg == b.frame.latitude_deg &&
          a.frame.longitude_deg == b.frame.longitude_deg && a.frame.height_msl_m == b.frame.height_msl_m);
}

}  // namespace emscape::volume
