/// The state of a FieldSolver between updates; for its own sources alone.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "emfield/field_engine.h"
#include "emfield/jamming.h"
#include "emscape/emfield/field_solver.h"

namespace emscape::emfield {

/// An emitter between updates.
struct EmitterCache {
  scenario::EmitterState state;  ///< at the last update
  GeodeticPosition computed_at;  ///< where the geometry was computed
  bool has_geometry = false;     ///< computed_at and the findings hold; the slot too if the emitter is cached
  bool is_cached = true;         ///< false: its geometry is given up after each use
  GeometryFindings findings;
  bool mount_changed = true;           ///< since the update before: moved, switched or turned as a whole
  std::vector<JammerInSight> jammers;  ///< radars, where jamming counts
};

struct FieldSolver::Impl {
  FieldOptions options;
  FieldSetup setup;
  Backend backend = Backend::cpu;       ///< cpu or cuda
  std::unique_ptr<FieldEngine> engine;  ///< a slot an emitter, and one for those that are not cached
  std::vector<EmitterCache> emitters;
  std::vector<std::vector<std::uint16_t>> masks;  ///< of channels with unknown columns
  std::map<std::string, long long> warning_counts;

  /// Emitters whose sum lies in the engine's resting accumulators; they have not changed since.
  std::vector<bool> resting;
  /// Emitters combined again though they had not changed, since the resting set was last chosen.
  int wasted = 0;
  bool is_first = true;

  Impl(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
       FieldOptions options_in);

  std::size_t chooseCached();
  std::unique_ptr<FieldEngine> makeEngine(std::size_t slot_bytes) const;
  void checkHoles() const;
  std::string placeOf(std::size_t column) const;
  void warn(const std::string& warning) { ++warning_counts[warning]; }

  FieldChanged findChanges(const scenario::Snapshot& snapshot);
  void computeGeometry(const std::vector<int>& chosen, bool into_scratch);
  void takeFindings(int e, GeometryFindings found);
  void chooseResting(const std::vector<bool>& changed);
  void combine(const std::vector<int>& chosen, const std::vector<bool>& channel_chosen, bool into_resting);
  CombineEmitter combineEmitter(int e) const;
  void findJamming(const scenario::Snapshot& snapshot, std::vector<bool>& emitter_changed);
  bool isAffected(const Channel& channel, const ChannelRecipe& recipe,
                  const std::vector<bool>& emitter_changed) const;
  std::vector<RadarShare> radarShares(int e) const;
  VolumeRequest volumeRequest(int channel, const scenario::Snapshot& snapshot);
  const std::vector<std::uint16_t>& maskOf(const Channel& channel, std::vector<std::uint16_t>& own) const;
};

}  // namespace emscape::emfield
