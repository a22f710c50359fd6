/// The state of a FieldSolver between updates; for its own sources alone.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "emfield/emitter_geometry.h"
#include "emfield/field_solver.h"
#include "emfield/grid_columns.h"
#include "emfield/products.h"

namespace emscape::emfield {

/// An emitter between updates.
struct EmitterCache {
  EmitterGeometry geometry;
  scenario::EmitterState state;  ///< at the last update
  GeodeticPosition computed_at;  ///< where the geometry was computed
  bool has_geometry =
      false;              ///< computed_at and unknown_columns hold; the arrays too if the emitter is cached
  bool is_cached = true;  ///< false: the arrays are given up after each use
  std::vector<bool> unknown_columns;  ///< empty: none
  double far_field_m = 0;
  long long near_voxels = 0;
};

/// Buffers of one channel.
struct ChannelState {
  ChannelRecipe recipe;
  std::vector<float> value, largest;                  ///< accumulator over all emitters
  std::vector<float> resting_value, resting_largest;  ///< accumulator over the resting emitters alone
  std::vector<std::shared_ptr<volume::DenseVolume>> pool;

  bool hasResting() const { return !resting_value.empty(); }
};

struct FieldSolver::Impl {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
  FieldOptions options;
  volume::Grid grid;
  GridColumns columns;
  FanResolution resolution;
  std::vector<int> first_row_k;
  std::vector<Channel> channels;
  std::vector<ChannelState> channel_states;
  std::vector<EmitterCache> emitters;
  std::vector<std::shared_ptr<const volume::DenseVolume>> volumes;
  std::map<std::string, long long> warning_counts;
  StageTimes times;
  EmitterGeometry scratch;  ///< of an emitter that is not cached

  /// Emitters whose sum lies in the channels' resting accumulators; they have not changed since.
  std::vector<bool> resting;
  /// Emitters combined again though they had not changed, since the resting set was last chosen.
  int wasted = 0;
  bool is_first = true;

  Impl(std::shared_ptr<const scenario::Scenario> scenario_in, scenario::TerrainPtr terrain_in,
       FieldOptions options_in);

  void checkModels() const;
  void checkHoles() const;
  std::string placeOf(std::size_t column) const;
  void warn(const std::string& warning) { ++warning_counts[warning]; }

  FieldChanged findChanges(const scenario::Snapshot& snapshot);
  void computeGeometry(int e, const scenario::EmitterState& state, EmitterGeometry& geometry);
  void countNearField(int e, const EmitterGeometry& geometry);
  void chooseResting(const std::vector<bool>& changed);
  void combine(const std::vector<int>& chosen, const std::vector<bool>& channel_chosen, bool into_resting);
  CombineEmitter combineEmitter(int e, const EmitterGeometry& geometry) const;
  void makeVolume(std::size_t channel, const scenario::Snapshot& snapshot);
  void maskUnknown(const Channel& channel, std::vector<std::uint16_t>& first_valid_k) const;
  std::shared_ptr<volume::DenseVolume> freeVolume(ChannelState& state) const;
};

}  // namespace emscape::emfield
