/// A profile prepared for single paths, on the host.
#pragma once

#include <vector>

#include "propagation/clear_air/column.h"
#include "propagation/clear_air/ground.h"

namespace emscape::propagation {

/// Holds the tables of a ClearAirColumn<double>. Not copyable: the column points into them. The profile must
/// outlive this object.
class ClearAirProfile {
 public:
  /// @param profile    at least two posts
  /// @param tx_msl_m   of the antenna
  /// @param clutterOf  (int) -> height (m) of the clutter at a post
  template <class ClutterOf>
  ClearAirProfile(const ClearAirModel<double>& model, const TerrainProfile& profile, const PathZones& zones,
                  double tx_msl_m, ClutterOf clutterOf)
      : memory_(3 * static_cast<std::size_t>(profile.count)) {
    double* const memory = memory_.data();
    const ClearAirPosts<double> posts{profile, memory, memory + profile.count, memory + 2 * profile.count};
    posts.fill(model.median.earth.wavelength_m, clutterOf);
    column_ = clearAirColumn(model, posts, zones, tx_msl_m);
  }
  ClearAirProfile(const ClearAirModel<double>& model, const TerrainProfile& profile,
                  const ClearAirGround& ground, double tx_msl_m)
      : ClearAirProfile(model, profile, zonesOf(ground.zone, profile), tx_msl_m,
                        [&](int post) { return static_cast<double>(ground.clutterAt(profile, post)); }) {}
  ClearAirProfile(const ClearAirProfile&) = delete;
  ClearAirProfile& operator=(const ClearAirProfile&) = delete;

  const ClearAirColumn<double>& column() const { return column_; }

 private:
  std::vector<double> memory_;
  ClearAirColumn<double> column_;
};

}  // namespace emscape::propagation
