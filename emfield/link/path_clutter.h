/// The clutter in the resolution cell of a point.
#pragma once

#include <map>
#include <vector>

#include "emfield/combine/clutter_echo.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// A radar's map of surface clutter, of which only the requested rows are filled, up to the range of a point.
/// One thread at a time may use an object.
class PathClutter {
 public:
  /// @param range_m  slant range of the point
  /// @param terrain  null: a smooth earth; must outlive this object
  PathClutter(const scenario::Snapshot& snapshot, int radar, double range_m,
              const scenario::Terrain* terrain);
  PathClutter(const PathClutter&) = delete;
  PathClutter& operator=(const PathClutter&) = delete;

  /// Clutter over noise at the point, as clutterToNoise() of the whole map.
  /// @param beam  with the look's frame and the radar's pattern
  float toNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim) const;

  /// As ClutterMapView::cellAt().
  ClutterCell cellAt(float azimuth_rad, float range_m) const;

 private:
  const std::vector<ClutterCell>& alongAzimuth(int azimuth) const;
  ClutterCell ofBeam(int row, int cell) const;

  double range_m_;
  ClutterMapTask task_;
  std::vector<double> post_ranges_m_;
  mutable std::map<int, std::vector<ClutterCell>> along_;
};

}  // namespace emscape::emfield
