/// All marches of an emitter's field: one per member of the air's ensemble and per polarisation, combined
/// into one table of losses.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "propagation/parabolic_equation/march/march_azimuths.h"

namespace emscape::propagation {

struct FieldMarch {
  AzimuthMarch march;                                       ///< without air and surface
  std::vector<PeSurface> surfaces;                          ///< of the polarisations, 1 or 2
  std::vector<std::vector<RefractivityAlongPath>> members;  ///< AzimuthMarch::air of each, at least one
  std::optional<double> quantile;  ///< of the members' powers (0..1); none: their mean
  /// Number of range cells of each azimuth that are marched and before missing terrain; empty: all.
  std::vector<int> known_ranges;

  std::size_t cellCount() const { return march.cellCount(); }
  /// Cost without halving: range steps of all azimuths of all marches times the initial N.
  double heights() const {
    return double(march.rangesOfAll()) * (march.cells.range_step_m / march.grid.range_step_m) *
           march.grid.intervals * double(surfaces.size() * members.size());
  }
  /// One of the marches.
  const AzimuthMarch& set(const std::vector<RefractivityAlongPath>& member, const PeSurface& surface) {
    march.air = member;
    march.surface = surface;
    return march;
  }
};

/// Loss (dB) of a cell without a field: finite, so that it can be interpolated.
constexpr float kPeNoField_db = 200;

/// Marches on the CPU, in parallel.
/// @param excess_db  field.cellCount() elements: losses over free space (dB) as of marchAzimuths(), of the
/// mean power of the polarisations and of the mean or the `quantile` of the members' powers; NaN in unknown
/// cells
/// @throws Error as marchAzimuths()
void marchField(FieldMarch& field, float* excess_db);

/// The loss of an ensemble.
/// @param losses_db  of the members, none NaN; reordered
float ofMembers_db(std::vector<float>& losses_db, const std::optional<double>& quantile);
/// Index of a quantile of the power in `members` losses in ascending order.
int rankOfQuantile(double quantile, int members);

/// True if the GPU supports the march, and the number of azimuths makes it faster.
bool isForGpu(const FieldMarch& field);

}  // namespace emscape::propagation
