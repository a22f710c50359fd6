#include "emfield/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "emfield/models/horizon.h"

namespace emscape::emfield {
namespace {

/// The grazing slopes of every azimuth of a fan.
class SlopePlanes {
 public:
  SlopePlanes(const HorizonGeometry<float>& geometry, const TerrainFan& fan)
      : geometry_(geometry), fan_(fan), slopes_(fan.height_msl_m.size()) {
    std::vector<RangeTerms<float>> ranges(fan.rangeCount());
    for (int i = 0; i < fan.rangeCount(); ++i) ranges[i] = geometry.termsAt(fan.ranges_m[i]);
    parallelFor(fan.azimuth_count, 8, [&](int begin, int end) {
      for (int a = begin; a < end; ++a) {
        if (fan.used_ranges[a] == 0) continue;
        grazingSlopes(geometry, fan.profile(a), ranges.data(), fan.used_ranges[a],
                      slopes_.data() + static_cast<std::size_t>(a) * fan.rangeCount());
      }
    });
  }

  /// Height above mean sea level (m) of the shadow's edge over a point of the ground.
  float edgeHeight_m(const FanCoordinates& point) const {
    const double position = fan_.azimuthIndex(point.azimuth_rad);
    const int azimuth = static_cast<int>(position);
    const float weight = static_cast<float>(position - azimuth);
    const int before = fan_.lastBefore(point.range_m);
    if (before == 0) return -std::numeric_limits<float>::infinity();
    const RangeTerms<float> range = geometry_.termsAt(point.range_m);
    const float left = geometry_.heightOn(slope(azimuth, before), range);
    const float right = geometry_.heightOn(slope(fan_.next(azimuth), before), range);
    return left + weight * (right - left);
  }

 private:
  float slope(int azimuth, int range) const {
    return slopes_[static_cast<std::size_t>(azimuth) * fan_.rangeCount() + range];
  }

  HorizonGeometry<float> geometry_;
  const TerrainFan& fan_;
  std::vector<float> slopes_;
};

/// z of the edge in a column that leans: the layers are tried from the top down.
float edgeInLeaningColumn(const Station& station, const SlopePlanes& planes, const GridColumns& columns,
                          const GridColumn& column) {
  const float lit = -std::numeric_limits<float>::infinity();
  float above_m = std::numeric_limits<float>::infinity();
  for (std::size_t k = columns.t_m.size(); k-- > 0;) {
    const double t_m = columns.t_m[k];
    const float edge_m =
        planes.edgeHeight_m(fanCoordinates(station, column.foot_ecef_m + column.foot_drift * t_m));
    if (std::isnan(edge_m)) return edge_m;
    if (!(heightMsl_m(column, t_m) >= edge_m)) return above_m;
    above_m = static_cast<float>(t_m);
  }
  return lit;
}

}  // namespace

std::vector<float> shadowEdges(const Station& station, const GridColumns& columns,
                               const std::vector<FanCoordinates>& coordinates, const TerrainFan& fan) {
  const SlopePlanes planes(
      {static_cast<float>(station.height_msl_m), static_cast<float>(station.effective_earth_radius_m)}, fan);
  std::vector<float> edges(coordinates.size());
  parallelFor(static_cast<int>(edges.size()), 1024, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      edges[c] = columns.tilted ? edgeInLeaningColumn(station, planes, columns, columns.columns[c])
                                : planes.edgeHeight_m(coordinates[c]);
    }
  });
  return edges;
}

}  // namespace emscape::emfield
