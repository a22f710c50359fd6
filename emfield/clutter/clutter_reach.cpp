#include "emfield/clutter/clutter_reach.h"

namespace emscape::emfield {

double clutterReach_m(const scenario::Region& region, const Station& station) {
  const Vec3d middle_m = {
      0, 0,
      region.size_m.z / 2 + (region.origin.kind == FrameKind::altitude ? region.origin.height_msl_m : 0)};
  return length(toEcef(GeoFrame(region.origin).toGeodetic(middle_m)) - station.ecef_m) +
         length(region.size_m) / 2;
}

}  // namespace emscape::emfield
