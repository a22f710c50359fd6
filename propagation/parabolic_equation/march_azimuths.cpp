#include "propagation/parabolic_equation/march_azimuths.h"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "propagation/parabolic_equation/lane_march.h"

namespace emscape::propagation {
namespace {

RadialPath pathOf(const AzimuthMarch& march, int azimuth) {
  RadialPath path;
  path.source = march.source;
  path.surface = march.surface;
  path.air = march.airOf(azimuth);
  if (!march.ground_msl_m.empty()) {
    const float* const first = march.ground_msl_m.data() + std::size_t(azimuth) * march.ground_steps;
    path.ground_msl_m.assign(first, first + march.ground_steps);
  }
  return path;
}

}  // namespace

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

MarchNotes marchAzimuths(const AzimuthMarch& march, float* excess_db) {
  checkMarch(march);
  MarchNotes notes;
  notes.pointwise_air =
      std::any_of(march.air.begin(), march.air.end(), [](const auto& air) { return air.pointwise(); });
  const std::size_t of_azimuth = std::size_t(march.cells.ranges) * std::size_t(march.cells.heights);
  std::mutex of_notes;
  const auto marchGroups = [&](const auto& groupMarch) {
    parallelFor((march.azimuths + kStepLanes - 1) / kStepLanes, 1, [&](int begin, int end) {
      for (int group = begin; group < end; ++group) {
        const int first = group * kStepLanes, count = std::min(kStepLanes, march.azimuths - first);
        auto of_group = groupMarch(first, count);
        RadialCells marched = march.cells;
        marched.ranges = march.rangesOfGroup(first);
        const auto cells = marchCells(of_group, marched);
        for (int l = 0; l < count; ++l) {
          const auto own = std::ptrdiff_t(march.rangesOf(first + l)) * marched.heights;
          std::copy_n(cells[l].begin(), own, excess_db + std::size_t(first + l) * of_azimuth);
        }
        const std::lock_guard lock(of_notes);
        notes.staircases += of_group.staircases();
      }
    });
  };
  if (march.grid.intervals >= kMinLaneIntervals) {
    const LaneMarchPlan plan = laneMarchPlan(march);
    marchGroups([&](int first, int count) { return LaneMarch(plan, first, count); });
  } else {
    marchGroups([&](int first, int count) {
      std::array<RadialPath, kStepLanes> paths;
      for (int l = 0; l < kStepLanes; ++l) paths[l] = pathOf(march, first + std::min(l, count - 1));
      return RadialMarch<float, kStepLanes>(march.grid, std::move(paths));
    });
  }
  return notes;
}

}  // namespace emscape::propagation
