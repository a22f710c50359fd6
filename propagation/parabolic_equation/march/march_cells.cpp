#include "propagation/parabolic_equation/march/march_cells.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/march/cell_span.h"
#include "propagation/parabolic_equation/march/lane_march.h"

namespace emscape::propagation {

template <class March>
std::array<std::vector<float>, March::kLaneCount> marchCells(March& march, const RadialCells& cells,
                                                             const std::function<void()>& ended) {
  constexpr int kLanes = March::kLaneCount;
  if (!(cells.range_step_m >= march.grid().range_step_m)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("parabolic_equation: cells of {} m in range; expected at least the "
                            "range step of {} m",
                            cells.range_step_m, march.grid().range_step_m));
  }
  std::array<std::vector<float>, kLanes> excess_db;
  excess_db.fill(std::vector<float>(std::size_t(cells.ranges) * cells.heights));
  std::vector<double> sums(std::size_t(cells.heights) * kLanes), before(sums.size());
  std::vector<int> counts(sums.size()), before_counts(sums.size());
  for (int i = 0; i < cells.ranges; ++i) {
    if (cells.overlap) {
      before = sums;
      before_counts = counts;
    }
    std::fill(sums.begin(), sums.end(), 0.0);
    std::fill(counts.begin(), counts.end(), 0);
    // steps in (begin, end]
    const double last_m = (i + 1) * cells.range_step_m * (1 + 1e-12) - march.grid().range_step_m;
    while (march.range_m() <= last_m) {
      checkpoint();
      march.advance();
      if (cells.are_points && march.range_m() <= last_m) continue;
      for (int l = 0; l < kLanes; ++l) {
        const double ground_m = cells.above_ground ? 0 : march.ground_m(l);
        const double below_m = cells.bottom_msl_m - ground_m, top_m = march.grid().usableTop_m();
        const double step_m = march.grid().top_m / march.intervals();
        for (int j = 0; j < cells.heights; ++j) {
          const auto [z1, z2] = cellSpan(below_m, cells.height_step_m, cells.meanHeight_m(), j,
                                         cells.are_points, step_m, top_m);
          if (z2 <= z1) continue;
          sums[std::size_t(j) * kLanes + l] += march.meanSquaredFactor(l, z1, z2);
          ++counts[std::size_t(j) * kLanes + l];
        }
      }
    }
    for (int l = 0; l < kLanes; ++l) {
      for (int j = 0; j < cells.heights; ++j) {
        const std::size_t of = std::size_t(j) * kLanes + l;
        const int count = before_counts[of] + counts[of];
        excess_db[l][std::size_t(i) * cells.heights + j] =
            count > 0 ? float(-10 * std::log10((before[of] + sums[of]) / count))
                      : std::numeric_limits<float>::quiet_NaN();
      }
    }
    if (ended) ended();
  }
  return excess_db;
}

template std::array<std::vector<float>, 1> marchCells(RadialMarch<double, 1>&, const RadialCells&,
                                                      const std::function<void()>&);
template std::array<std::vector<float>, 1> marchCells(RadialMarch<float, 1>&, const RadialCells&,
                                                      const std::function<void()>&);
template std::array<std::vector<float>, 8> marchCells(LaneMarch&, const RadialCells&,
                                                      const std::function<void()>&);

}  // namespace emscape::propagation
