/// Stage 2 of the model `horizon`: the height below which a column is in shadow; for host and device.
#pragma once

#include <cmath>

#include "emfield/excess/fill_excess.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "propagation/horizon/horizon.h"

namespace emscape::emfield {

using propagation::HorizonGeometry;
using propagation::RangeTerms;

/// Height of a point above mean sea level from that on the effective earth, in an exponential atmosphere. A
/// separate call, to save registers in the other loops.
[[gnu::noinline]] EMSCAPE_HD inline float heightOfImage_m(const Station& station, float image_m,
                                                          double range_m) {
  return float(station.refraction.heightOfImage_m(double(image_m), station.height_msl_m, range_m));
}

/// One emitter of the model `horizon` over the columns of a grid.
struct ShadowTask {
  Station station;
  GroundPosts ground;
  const RangeTerms<float>* terms = nullptr;  ///< of the posts' ranges; not read over a smooth earth
  float highest_msl_m = HUGE_VALF;           ///< see highestPost_m()

  EMSCAPE_HD HorizonGeometry<float> geometry() const {
    return {float(station.effective_height_msl_m), float(station.effective_earth_radius_m)};
  }

  /// z (m, in the grid's frame) of the shadow's edge in a column: voxels at or above it are in sight.
  /// -infinity: nothing is in shadow; +infinity: everything is; NaN: unknown, because the path crosses
  /// missing terrain. A tilted column that leaves and enters shadow is in shadow up to its last voxel in
  /// shadow.
  /// @param slopeTo  float(FastInverse, count): GrazingSlope of posts 1..count - 1 toward a point
  template <class SlopeTo>
  EMSCAPE_HD float edge_m(const ExcessGrid& grid, std::size_t c, const SlopeTo& slopeTo) const {
    if (!grid.tilted) {
      const FastInverse point = grid.coordinatesOf(station, c, 0);
      const float edge_msl_m = edgeHeight_m(slopeBefore(point, slopeTo), point.distance_m);
      return edge_msl_m - float(grid.columns[c].height_msl_m[0]);
    }
    float above_m = HUGE_VALF;
    for (int segment = grid.segments - 1; segment >= 0; --segment) {
      const float slope = slopeBefore(grid.coordinatesOf(station, c, segment), slopeTo);
      for (int k = grid.firstLayer(segment + 1) - 1; k >= grid.firstLayer(segment); --k) {
        const double t_m = double(grid.t_m[k]);
        const float edge_m = edgeHeight_m(slope, footInverse(station, grid.columns[c], t_m).distance_m);
        if (std::isnan(edge_m)) return edge_m;
        if (!(heightMsl_m(grid.columns[c], t_m) >= double(edge_m))) return above_m;
        above_m = grid.t_m[k];
      }
    }
    return -HUGE_VALF;
  }

  /// First of the posts 1..count - 1 toward a column's ground that may hide a voxel of it: from a station
  /// above all terrain nearer posts are below the line of sight to the lowest voxel.
  EMSCAPE_HD int firstPost(const ExcessGrid& grid, std::size_t c, const FastInverse& path, int count) const {
    const HorizonGeometry<float> g = geometry();
    const float above_m = g.station_height_msl_m - highest_msl_m;
    const int lowest = grid.firstValid(c);
    if (grid.tilted || station.refraction.exponential || !(above_m > 0) || lowest >= grid.layers) return 1;
    const auto height_msl_m = float(heightMsl_m(grid.columns[c], double(grid.t_m[lowest])));
    constexpr float kRounding = 2e-5f;  // rad
    const float slope = g.slopeTo(height_msl_m, g.termsAt(path.distance_m)) - kRounding;
    // Up to the horizon of a sphere at that height the slope to it rises with the range.
    const int rising = ground.lastBefore(double(std::sqrt(1.9f * g.effective_earth_radius_m * above_m))) + 1;
    int begin = 1, end = rising < count ? rising : count;
    while (begin < end) {
      const int middle = (begin + end) / 2;
      const bool is_below = g.slopeTo(highest_msl_m, terms[middle]) < slope;
      begin = is_below ? middle + 1 : begin;
      end = is_below ? end : middle;
    }
    return begin;
  }

  /// Slope that none of the posts `first` to `last` exceeds, none of which is higher than a height.
  EMSCAPE_HD float slopeBound(int first, int last, float height_msl_m) const {
    constexpr float kRounding_m = 0.01f;
    const HorizonGeometry<float> g = geometry();
    const float from_centre_m = g.effective_earth_radius_m + height_msl_m + kRounding_m;
    const float rise_m =
        height_msl_m + kRounding_m - g.station_height_msl_m - terms[first].versine * from_centre_m;
    return rise_m / (terms[rise_m > 0 ? first : last].sine * from_centre_m);
  }

  /// Height (m above mean sea level) of the grazing ray over a range.
  EMSCAPE_HD float edgeHeight_m(float slope, double range_m) const {
    return edgeHeight_m(slope, range_m, geometry().termsAt(range_m));
  }
  /// @param terms_of_range  geometry().termsAt() the range
  EMSCAPE_HD float edgeHeight_m(float slope, double range_m, const RangeTerms<float>& terms_of_range) const {
    if (std::isinf(slope)) return slope;
    if (!(range_m <= 0.5 * kPi * station.earth_radius_m)) return HUGE_VALF;
    const float edge_m = geometry().heightOn(slope, terms_of_range);
    if (!station.refraction.exponential || std::isnan(edge_m)) return edge_m;
    return heightOfImage_m(station, edge_m, range_m);
  }

 private:
  template <class SlopeTo>
  EMSCAPE_HD float slopeBefore(const FastInverse& point, const SlopeTo& slopeTo) const {
    if (ground.is_smooth) return propagation::smoothGrazingSlope(geometry(), point.distance_m);
    const int before = ground.lastBefore(point.distance_m);
    return before == 0 ? -HUGE_VALF : slopeTo(point, before + 1);
  }
};

}  // namespace emscape::emfield
