#include "emscape/volume/grid.h"

namespace emscape::volume {

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
