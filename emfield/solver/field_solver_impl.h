/// The state of a FieldSolver between updates; internal to its sources.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emfield/link/jammers.h"
#include "emfield/solver/beam_positions.h"
#include "emfield/solver/column_step.h"
#include "emfield/solver/field_engine.h"
#include "emfield/solver/field_inputs.h"
#include "emfield/solver/interval_beam.h"
#include "emscape/emfield/solver/field_solver.h"

namespace emscape::emfield {

/// Warnings with their counts.
using WarningCounts = std::map<std::string, long long>;

/// Ground that is too steep for an emitter's marches.
struct SteepCache {
  std::shared_ptr<const propagation::SteepGround> ground;  ///< at the position where most is lost; null: none
  std::optional<std::string> text;  ///< propagation::steepGroundWarning() of it, once it was asked for
};

/// An emitter between updates.
struct EmitterCache {
  scenario::EmitterState state;            ///< at the last update
  std::optional<GeometryInputs> geometry;  ///< of geometry_result, and of the slot if the emitter is cached
  std::optional<CombinePass::Member> combined;  ///< its contribution to the sums; none: not active
  std::optional<IntervalBeam> interval;         ///< none: not active, or the output is of an instant
  bool is_cached = true;                        ///< false: its geometry is discarded after each use
  GeometryResult geometry_result;
  double every_column_ms = 0;       ///< the last known one of GeometryResult
  bool mount_changed = true;        ///< since the previous update: moved, switched or turned as a whole
  std::vector<JammerPath> jammers;  ///< of radars, for quantities with jamming
  WarningCounts warnings, jamming_warnings;
  SteepCache steep;
};

/// Columns of a channel that are unknown to its emitters.
struct ChannelMask {
  std::vector<std::uint16_t> first_valid_k;  ///< as in DenseVolume; empty: that of all channels
  std::vector<std::uint8_t> partly_unknown;  ///< as FieldSolver::partlyUnknown()
};

struct FieldSolver::Impl {
  FieldOptions options;
  FieldSetup setup;
  Backend backend = Backend::cpu;  ///< cpu or cuda
  std::unique_ptr<FieldEngine>
      engine;  ///< one slot per emitter plus a shared one for emitters that are not cached
  MemoryEstimate estimate;
  std::vector<EmitterCache> emitters;
  std::vector<ChannelMask> masks;  ///< one per channel
  std::vector<volume::Volume> volumes;
  PatternReaches reaches;
  ColumnPace pace;

  /// Number of emitters, counted from the first, whose sum is in the engine's static accumulators.
  int static_count = 0;
  /// Number of unchanged emitters that were combined again since the static sum was last computed.
  int recombined_since = 0;
  bool is_first = true;
  bool is_stale = false;              ///< an update failed: all results are invalid
  bool has_other_quantities = false;  ///< the options have, since the plan was made

  /// @param columns_in  those of the scenario's region, if they are known; else empty
  Impl(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
       FieldOptions options_in, GridColumns columns_in = {});

  std::vector<bool> chooseCached(const FieldPlan& plan, std::size_t* slot_bytes) const;
  /// True if the columns are only in the memory of the GPU.
  bool hasDeviceColumns() const;
  void requireFieldMemory();
  void makeColumns();
  bool mayLackTerrain() const;  ///< of the options or the scenario
  void checkHoles() const;
  std::string placeOf(std::size_t column) const;

  /// Changes by an edit or the time, during an update.
  struct Changes {
    FieldChanged report;
    bool all = false;                   ///< everything is recomputed
    bool all_sums = false;              ///< the channels have other sums
    bool is_edited = false;             ///< the scenario is a different object
    const FieldPlan* before = nullptr;  ///< the plan before an edit
    std::vector<bool> emitters;         ///< true if its contribution to some channel changed
    std::vector<bool> sums;             ///< channels whose sums change
    std::vector<bool> products;         ///< channels whose product changes
  };

  bool hasSameGrid(const FieldPlan& plan, const scenario::TerrainPtr& terrain) const;
  bool canKeep(const FieldPlan& plan, const scenario::TerrainPtr& terrain) const;
  FieldChanged updateFrom(Impl& former, const scenario::Snapshot& snapshot);
  void exchangeGeometry(int e, Impl& other, int other_e);
  FieldChanged update(const scenario::Snapshot& snapshot, std::optional<FieldPlan> edited);
  void compute(const scenario::Snapshot& snapshot, Changes& changes);
  void setEnginePlan(bool channels_changed);
  void discardResults(bool keeps_geometry);

  void findMoved(const scenario::Snapshot& snapshot, Changes& changes);
  void findIntervals(const scenario::Snapshot& snapshot);
  void tellSteepGround();
  void findJamming(const scenario::Snapshot& snapshot, const Changes& changes);
  void findCombined(const scenario::Snapshot& snapshot, Changes& changes);
  void findProducts(Changes& changes);
  void chooseStep(const std::vector<int>& moved);
  double columns_ms(const std::vector<int>& computed) const;
  ColumnPart partOf(int e, bool into_scratch) const;
  void computeGeometry(const std::vector<int>& chosen, bool into_scratch);
  void takeGeometry(int e, GeometryResult found);
  void noteWarnings(int e);
  void chooseResting(const std::vector<bool>& changed);
  void combine(int begin, int end, const std::vector<bool>& channel_chosen, bool into_static_sums);
  CombinePass::Member combineMember(const scenario::Snapshot& snapshot, int e);
  std::vector<RadarShare> radarShares(const scenario::Snapshot& snapshot, int e) const;
  std::vector<OccupancyShare> occupancyShares(const scenario::Snapshot& snapshot, int e);
  void makeVolumes(const scenario::Snapshot& snapshot, const Changes& changes);
  VolumeRequest volumeRequest(int channel, const scenario::Snapshot& snapshot);
  const std::vector<std::uint16_t>& maskOf(const Channel& channel, ChannelMask& mask) const;
};

}  // namespace emscape::emfield
