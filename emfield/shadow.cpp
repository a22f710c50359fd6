#include "emfield/shadow.h"

#include <vector>

#include "emfield/shadow_edge.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

/// Of all azimuths of a fan, range fastest.
std::vector<float> slopesOf(const HorizonGeometry<float>& geometry, const FanShape& shape,
                            const TerrainFan& fan) {
  std::vector<float> slopes(fan.height_msl_m.size());
  std::vector<RangeTerms<float>> ranges(fan.range_count);
  for (int i = 0; i < fan.range_count; ++i) ranges[i] = geometry.termsAt(shape.ranges_m[i]);
  parallelFor(fan.interval_count + 1, 8, [&](int begin, int end) {
    for (int a = begin; a < end; ++a) {
      const std::size_t first = static_cast<std::size_t>(a) * fan.range_count;
      grazingSlopes(geometry, fan.height_msl_m.data() + first, ranges.data(),
                    shape.used_ranges[fan.first_interval + a], slopes.data() + first);
    }
  });
  return slopes;
}

}  // namespace

void findShadowEdges(const Station& station, const GridColumns& columns,
                     const std::vector<FanCoordinates>& coordinates, const FanShape& shape,
                     const TerrainFan& fan, std::vector<float>& edges_m) {
  SlopePlanes planes;
  planes.geometry = horizonGeometry<float>(station);
  planes.fan = shape.view();
  planes.first_interval = fan.first_interval;
  planes.azimuth_stride = fan.range_count;
  planes.range_stride = 1;
  const std::vector<float> slopes = slopesOf(planes.geometry, shape, fan);
  planes.slopes = slopes.data();
  parallelFor(static_cast<int>(edges_m.size()), 1024, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      if (columns.tilted) {
        edges_m[c] = edgeInLeaningColumn(station, planes, columns.columns[c], columns.t_m.data(),
                                         static_cast<int>(columns.t_m.size()));
        continue;
      }
      const double azimuth_index = planes.fan.azimuthIndex(coordinates[c].azimuth_rad);
      const int interval = static_cast<int>(azimuth_index) - fan.first_interval;
      if (interval >= 0 && interval < fan.interval_count) {
        edges_m[c] = planes.edgeHeight_m(azimuth_index, coordinates[c].range_m);
      }
    }
  });
}

}  // namespace emscape::emfield
