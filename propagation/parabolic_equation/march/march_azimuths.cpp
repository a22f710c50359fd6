#include "propagation/parabolic_equation/march/march_azimuths.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/march/lane_march.h"

namespace emscape::propagation {

int AzimuthMarch::rangesOfGroup(int azimuth) const {
  const int first = azimuth / kStepLanes * kStepLanes;
  int most = 0;
  for (int a = first; a < std::min(first + kStepLanes, azimuths); ++a) most = std::max(most, rangesOf(a));
  return most;
}

void checkMarch(const AzimuthMarch& march) {
  checkGrid(march.grid);
  if (march.air.size() != 1 && march.air.size() != std::size_t(march.azimuths)) {
    throw Error(ErrorCode::bad_input,
                "parabolic_equation: expected one profile of the air, or one per azimuth");
  }
  if (!march.ground_msl_m.empty() &&
      march.ground_msl_m.size() != march.ground_steps * std::size_t(march.azimuths)) {
    throw Error(ErrorCode::bad_input, "parabolic_equation: expected terrain for every azimuth");
  }
  if (!march.ranges.empty() && march.ranges.size() != std::size_t(march.azimuths)) {
    throw Error(ErrorCode::bad_input, "parabolic_equation: expected a number of cells for every azimuth");
  }
  if (march.cells.ranges > 0 && !(march.cells.range_step_m >= march.grid.range_step_m)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("parabolic_equation: cells of {} m in range; expected at least the "
                            "range step of {} m",
                            march.cells.range_step_m, march.grid.range_step_m));
  }
}

void marchAzimuths(const AzimuthMarch& march, float* excess_db) {
  checkMarch(march);
  const std::size_t of_azimuth = std::size_t(march.cells.ranges) * std::size_t(march.cells.heights);
  const int groups = (march.azimuths + kStepLanes - 1) / kStepLanes;
  double all = 0;
  for (int group = 0; group < groups; ++group) all += march.rangesOfGroup(group * kStepLanes);
  std::atomic<int> marched_ranges = 0;
  const LaneMarchPlan plan = laneMarchPlan(march);
  parallelFor(groups, 1, [&](int begin, int end) {
    for (int group = begin; group < end; ++group) {
      const int first = group * kStepLanes, count = std::min(kStepLanes, march.azimuths - first);
      LaneMarch of_group(plan, first, count);
      RadialCells marched = march.cells;
      marched.ranges = march.rangesOfGroup(first);
      const auto cells = marchCells(of_group, marched, [&] { reportDone(++marched_ranges / all); });
      for (int l = 0; l < count; ++l) {
        const auto own = std::ptrdiff_t(march.rangesOf(first + l)) * marched.heights;
        std::copy_n(cells[l].begin(), own, excess_db + std::size_t(first + l) * of_azimuth);
      }
    }
  });
}

}  // namespace emscape::propagation
