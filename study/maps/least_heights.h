/// The minimum heights above ground at which a quantity reaches thresholds, at each position.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "emscape/emfield/solver/field_solver.h"
#include "emscape/study/maps/map.h"
#include "emscape/study/maps/map_grid.h"

namespace emscape::study {

/// Heights are searched from the ground to kHighestSearched_m in 64 steps, which all thresholds share, then
/// below the first step that reaches a threshold in 16 steps, repeatedly down to kMinHeightAccuracy_m.
/// Lower intervals of heights thinner than a first step (160 m) may be missed.
constexpr double kHighestSearched_m = 10240;
constexpr double kMinHeightAccuracy_m = 0.625;

/// Finds minimum heights on a map. For one thread at a time.
class LeastHeights {
 public:
  /// @param grid        must outlive this object
  /// @param thresholds  of one quantity
  /// @param options     the rest is set here
  LeastHeights(const MapGrid& grid, std::vector<double> thresholds, const emfield::FieldOptions& options);

  /// The field of the first steps is kept for the next scenario or time, so that only changes are computed,
  /// unless the map is larger than one strip.
  /// @param scenario  with the quantity as its only output
  /// @return for each threshold, heights (m) that reach it, at most kMinHeightAccuracy_m above the minimum;
  /// 0 on the ground; NaN: none does, or the position has no value
  std::vector<std::vector<float>> compute(const std::shared_ptr<const scenario::Scenario>& scenario,
                                          const scenario::TerrainPtr& terrain, double time_s);

  /// What a height of the last compute() says: exact; bound if emitters whose path is unknown may reach the
  /// threshold below it; of NaN unknown, or none: no height reaches the threshold, or the position is left
  /// out.
  PixelAnswer answer(std::size_t position, float height_m) const;

 private:
  const MapGrid& grid_;
  std::vector<double> thresholds_;
  emfield::FieldOptions options_;
  std::optional<emfield::FieldSolver> first_steps_;
  std::vector<PixelAnswer> known_;  ///< one per position
};

}  // namespace emscape::study
