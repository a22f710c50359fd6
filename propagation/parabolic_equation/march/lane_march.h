/// The march of eight azimuths at once in float: march_lanes.h.
#pragma once

#include <array>
#include <vector>

#include "propagation/parabolic_equation/march/march_block_input.h"
#include "propagation/parabolic_equation/march/march_lanes.h"

namespace emscape::propagation {

/// Tables shared by all groups of eight azimuths of a march, for one N.
struct LaneMarchTables {
  MarchBlockTask task;
  std::vector<StoredComplex> propagator;   ///< flat ground
  std::vector<FlatExponent> exponents;     ///< terrain
  std::vector<StoredComplex> half_screen;  ///< steady air over flat ground
  std::vector<StoredComplex> absorbed;     ///< otherwise: magnitude of the half screen and its logarithm
  LaneSurface surface;                     ///< mixed transform
};

/// Tables of a whole march; shared by threads.
struct LaneMarchPlan {
  AzimuthMarch const* march = nullptr;
  BlockInput input;
  std::vector<LaneMarchTables> tables;  ///< of each N of the input
};
/// @param march  must outlive the plan
/// @throws Error as blockInput(), for N outside kMinBlockIntervals .. kMaxLaneIntervals
LaneMarchPlan laneMarchPlan(const AzimuthMarch& march);

/// Not for several threads at once.
class LaneMarch {
 public:
  static constexpr int kLaneCount = kStepLanes;

  /// @param first, count  azimuths, 1 to 8
  LaneMarch(const LaneMarchPlan& plan, int first, int count);

  void advance();
  double range_m() const { return step_ * task().range_step_m; }
  double ground_m(int lane) const { return states_[std::size_t(lane)].ground_m; }
  const MarchGrid& grid() const { return plan_.march->grid; }
  int intervals() const { return transform_.intervals(); }
  /// RadialMarch::meanSquaredFactor().
  double meanSquaredFactor(int lane, double z1_m, double z2_m);

 private:
  const LaneMarchTables& tables() const { return plan_.tables[level_]; }
  const MarchBlockTask& task() const { return tables().task; }
  const PlannedStep& planned(int lane) const;
  void planGround();
  void prepareAir();
  void screen();
  void shift(int lane, int by);
  void halve();

  const LaneMarchPlan& plan_;
  int first_, count_, step_ = 0;
  std::size_t level_ = 0;  ///< of plan_.tables
  LaneTransform transform_;
  std::array<MarchState, kStepLanes> states_;  ///< all end at the last one's end
  std::vector<PlannedStep> planned_;
  struct Air {
    std::vector<float> level_m, units, gradient;
  };
  std::array<Air, kStepLanes> air_;  ///< that of lane 0 alone, if it is common
  std::vector<StepLanes> field_, half_screen_;
  std::vector<float> power_;  ///< F^2 by height and lane
  bool has_power_ = false;
};

}  // namespace emscape::propagation
