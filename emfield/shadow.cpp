#include "emfield/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "emfield/models/horizon.h"

namespace emscape::emfield {
namespace {

/// The grazing slopes of a fan's azimuths.
class SlopePlanes {
 public:
  SlopePlanes(const Station& station, const FanShape& shape, const TerrainFan& fan)
      : geometry_{static_cast<float>(station.height_msl_m),
                  static_cast<float>(station.effective_earth_radius_m)},
        shape_(shape),
        fan_(fan),
        slopes_(fan.height_msl_m.size()) {
    std::vector<RangeTerms<float>> ranges(fan.range_count);
    for (int i = 0; i < fan.range_count; ++i) ranges[i] = geometry_.termsAt(shape.ranges_m[i]);
    parallelFor(fan.interval_count + 1, 8, [&](int begin, int end) {
      for (int a = begin; a < end; ++a) {
        const std::size_t first = static_cast<std::size_t>(a) * fan.range_count;
        grazingSlopes(geometry_, fan.height_msl_m.data() + first, ranges.data(),
                      shape.used_ranges[fan.first_interval + a], slopes_.data() + first);
      }
    });
  }

  /// Height above mean sea level (m) of the shadow's edge over a point of the ground.
  /// @param azimuth_index  of the shape, within the fan's intervals
  float edgeHeight_m(double azimuth_index, double range_m) const {
    if (range_m > shape_.ranges_m.back()) return std::numeric_limits<float>::infinity();
    const int interval = static_cast<int>(azimuth_index);
    const float weight = static_cast<float>(azimuth_index - interval);
    const int before = shape_.lastBefore(range_m);
    if (before == 0) return -std::numeric_limits<float>::infinity();
    const RangeTerms<float> terms = geometry_.termsAt(range_m);
    const float* slope =
        slopes_.data() + static_cast<std::size_t>(interval - fan_.first_interval) * fan_.range_count;
    const float left = geometry_.heightOn(slope[before], terms);
    const float right = geometry_.heightOn(slope[fan_.range_count + before], terms);
    return left + weight * (right - left);
  }

 private:
  HorizonGeometry<float> geometry_;
  const FanShape& shape_;
  const TerrainFan& fan_;
  std::vector<float> slopes_;
};

/// z of the edge in a column that leans: the layers are tried from the top down.
float edgeInLeaningColumn(const Station& station, const FanShape& shape, const SlopePlanes& planes,
                          const GridColumns& columns, const GridColumn& column) {
  const float lit = -std::numeric_limits<float>::infinity();
  float above_m = std::numeric_limits<float>::infinity();
  for (std::size_t k = columns.t_m.size(); k-- > 0;) {
    const double t_m = columns.t_m[k];
    const FanCoordinates point = fanCoordinates(station, column.foot_ecef_m + column.foot_drift * t_m);
    const float edge_m = planes.edgeHeight_m(shape.azimuthIndex(point.azimuth_rad), point.range_m);
    if (std::isnan(edge_m)) return edge_m;
    if (!(heightMsl_m(column, t_m) >= edge_m)) return above_m;
    above_m = static_cast<float>(t_m);
  }
  return lit;
}

}  // namespace

void findShadowEdges(const Station& station, const GridColumns& columns,
                     const std::vector<FanCoordinates>& coordinates, const FanShape& shape,
                     const TerrainFan& fan, std::vector<float>& edges_m) {
  const SlopePlanes planes(station, shape, fan);
  parallelFor(static_cast<int>(edges_m.size()), 1024, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      if (columns.tilted) {
        edges_m[c] = edgeInLeaningColumn(station, shape, planes, columns, columns.columns[c]);
        continue;
      }
      const double azimuth_index = shape.azimuthIndex(coordinates[c].azimuth_rad);
      const int interval = static_cast<int>(azimuth_index) - fan.first_interval;
      if (interval >= 0 && interval < fan.interval_count) {
        edges_m[c] = planes.edgeHeight_m(azimuth_index, coordinates[c].range_m);
      }
    }
  });
}

}  // namespace emscape::emfield
