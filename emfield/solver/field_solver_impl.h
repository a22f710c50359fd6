/// The state of a FieldSolver between updates; for its own sources alone.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emfield/link/jammers.h"
#include "emfield/solver/field_engine.h"
#include "emfield/solver/field_inputs.h"
#include "emscape/emfield/field_solver.h"

namespace emscape::emfield {

/// Warnings with their counts.
using WarningCounts = std::map<std::string, long long>;

/// An emitter between updates.
struct EmitterCache {
  scenario::EmitterState state;            ///< at the last update
  std::optional<GeometryInputs> geometry;  ///< of findings, and of the slot if the emitter is cached
  std::optional<CombineInputs> combined;   ///< its part in the sums; none: not active
  bool is_cached = true;                   ///< false: its geometry is given up after each use
  GeometryFindings findings;
  bool mount_changed = true;           ///< since the update before: moved, switched or turned as a whole
  std::vector<JammerInSight> jammers;  ///< radars, where jamming counts
  WarningCounts warnings, jamming_warnings;
};

struct FieldSolver::Impl {
  FieldOptions options;
  FieldSetup setup;
  Backend backend = Backend::cpu;       ///< cpu or cuda
  std::unique_ptr<FieldEngine> engine;  ///< a slot for each emitter, and one for those that are not cached
  std::vector<EmitterCache> emitters;
  std::vector<std::vector<std::uint16_t>> masks;  ///< of channels with unknown columns
  std::vector<volume::Volume> volumes;

  /// So many emitters, the first ones, have their sum in the engine's resting accumulators.
  int resting = 0;
  /// Emitters combined again though they had not changed, since the resting sum was last made.
  int wasted = 0;
  bool is_first = true;
  bool is_stale = false;  ///< an update failed: nothing that was computed counts

  Impl(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
       FieldOptions options_in);

  std::vector<bool> chooseCached(const FieldPlan& plan, std::size_t* slot_bytes) const;
  std::unique_ptr<FieldEngine> makeEngine(std::size_t slot_bytes) const;
  void checkHoles() const;
  std::string placeOf(std::size_t column) const;

  /// What an edit or the time changed, while an update is computed.
  struct Changes {
    FieldChanged report;
    bool all = false;                   ///< everything is computed anew
    bool is_edited = false;             ///< by another scenario
    const FieldPlan* before = nullptr;  ///< the plan before an edit
    std::vector<bool> emitters;         ///< whose part in some channel is another one
    std::vector<bool> sums;             ///< channels whose sums change
    std::vector<bool> products;         ///< channels of which at least the product changes
  };

  bool canKeep(const FieldPlan& plan, const scenario::TerrainPtr& terrain) const;
  FieldChanged update(const scenario::Snapshot& snapshot, std::optional<FieldPlan> edited);
  void compute(const scenario::Snapshot& snapshot, Changes& changes);
  void setEnginePlan(bool channels_changed);
  void discardAll();

  void findMoved(const scenario::Snapshot& snapshot, Changes& changes);
  void findJamming(const scenario::Snapshot& snapshot, const Changes& changes);
  void findCombined(Changes& changes);
  void findProducts(Changes& changes);
  void computeGeometry(const std::vector<int>& chosen, bool into_scratch);
  void takeFindings(int e, GeometryFindings found);
  void chooseResting(const std::vector<bool>& changed);
  void combine(int begin, int end, const std::vector<bool>& channel_chosen, bool into_resting);
  CombineInputs combineInputs(int e) const;
  std::vector<RadarShare> radarShares(int e) const;
  void makeVolumes(const scenario::Snapshot& snapshot, const Changes& changes);
  VolumeRequest volumeRequest(int channel, const scenario::Snapshot& snapshot);
  const std::vector<std::uint16_t>& maskOf(const Channel& channel, std::vector<std::uint16_t>& own) const;
};

}  // namespace emscape::emfield
