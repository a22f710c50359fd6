#include <gtest/gtest.h>

#include "emscape/base/geodesy/geo_frame.h"
#include "tests/scenario/dem_file.h"

namespace emscape {
namespace {

TEST(FrameWkt, ProjectsAsTheFrame) {
  for (const FrameKind kind : {FrameKind::altitude, FrameKind::enu}) {
    SCOPED_TRACE(toString(kind));
    const FrameOrigin origin{kind, -33.25, 179.9, 750};
    std::string wkt = wktOf(origin);  // without the heights, whose grid PROJ may not have
    const std::size_t plane = wkt.find("PROJCRS["), heights = wkt.find(",VERTCRS[");
    if (plane != std::string::npos) wkt = wkt.substr(plane, heights - plane);
    const auto found = test::projected(wkt, -33.1, -179.8);
    const Vec3d expected = GeoFrame(origin).toLocal({-33.1, -179.8, 0});
    EXPECT_NEAR(found[0], expected.x, 1e-3);
    EXPECT_NEAR(found[1], expected.y, 1e-3);
  }
}

}  // namespace
}  // namespace emscape
