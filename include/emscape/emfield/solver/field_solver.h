/// Scenario and time to volumes: the pipeline columns -> excess -> combine -> product, with its caches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/emfield/solver/steep_ground.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/device_volume.h"
#include "emscape/volume/volume.h"

namespace emscape::scenario {
struct PlatformPose;
}

namespace emscape::emfield {

/// Contents of one volume of the output.
struct Channel {
  scenario::Quantity quantity = scenario::Quantity::power_density_dbwm2;
  std::string name;  ///< quantity, with ":" and the emitter's or band's name if it is not the sum of all
  std::vector<int> emitters;      ///< indices of its emitters
  std::vector<int> jammers = {};  ///< indices of their jammers, for quantities with jamming
};

/// The channels of a scenario's output: one per quantity, or one per quantity and emitter (combine
/// per_emitter) or band.
/// @param quantities  names; empty: the scenario's own
/// @throws Error (bad_input)
std::vector<Channel> channelsOf(const scenario::Scenario& scenario,
                                const std::vector<std::string>& quantities);
/// The same with a combination other than the scenario's.
std::vector<Channel> channelsOf(const scenario::Scenario& scenario,
                                const std::vector<std::string>& quantities, scenario::CombineMode combine);

struct FieldOptions {
  std::vector<std::string> quantities;  ///< empty: the scenario's
  /// True: after the channels of the scenario's combination come those of each emitter, from the same
  /// geometry.
  bool also_per_emitter = false;
  /// True: after those come the channels of quantities with jamming once more, as without jammers.
  bool also_unjammed = false;
  bool allow_missing_terrain =
      false;  ///< true: columns over holes, and those that are seen only across one, are masked
  /// A column that is unknown to some of a channel's active emitters, but not to all. True: it has the value
  /// of the others, if emitters can only raise the channel's quantity: the value is then at least that
  /// (FieldSolver::partlyUnknown()). False, and for other quantities: it is masked.
  bool keep_partly_unknown = false;
  Backend backend = Backend::cpu;  ///< automatic: the GPU if there is one with enough memory, else the CPU
  /// Null: the field is computed at the voxels of the scenario's region. Else at the points of this surface:
  /// volumes then have the dimensions width x height x number of heights, and no position on the earth.
  std::shared_ptr<const Surface> surface;
  /// cuda: storage of volumes. float16 needs less memory.
  volume::VoxelPrecision device_precision = volume::VoxelPrecision::float32;
  /// An emitter that moved less than this (m) with time keeps its geometry. Edits are exact.
  double move_tolerance_m = 0.5;
  /// Limit of the per-emitter caches (bytes; of the GPU's memory with cuda); 0: none. Emitters that do not
  /// fit are recomputed at each update.
  std::size_t cache_bytes = 0;
};

/// Result of an update. `any` is one event for a frame controller.
struct FieldChanged {
  bool any = false;
  bool grid = false;      ///< all volumes are new: the first update, or another region, terrain, emitter list
  bool channels = false;  ///< channels() may have changed
  std::vector<int>
      moved;  ///< emitters whose geometry (columns and excess losses) was recomputed or completed
  std::vector<int> turned;   ///< emitters of which only inputs of the combine stage changed: beam, power,
                             ///< activity, ...; also emitters in no channel that moved
  std::vector<int> volumes;  ///< channels whose volume was recomputed
};

/// Times (ms) and work of the stages of the last update; with cuda by the GPU's clock.
struct StageTimes {
  double columns_ms = 0;
  double march_ms = 0;  ///< of models that march outwards
  double excess_ms = 0, combine_ms = 0, product_ms = 0;
  /// Work of those models: azimuths times range steps times heights at the start.
  double marched_heights = 0;
};

struct MemoryUse {
  double bytes_per_voxel_and_emitter = 0;   ///< excess losses and reflected rays, mean over the emitters
  double bytes_per_column_and_emitter = 0;  ///< geometry cache
  double bytes_per_voxel_and_channel = 0;   ///< sums and output
  std::size_t total_bytes = 0;
  int uncached_emitters = 0;
};

/// Upper bounds of the memory (bytes) of a field, on the host or GPU that computes it. The constructor
/// refuses a field if their sum exceeds the free memory; on the host the columns are added to it.
struct MemoryEstimate {
  std::size_t volumes = 0;   ///< sums over the emitters and the channels' volumes; with cuda also columns and
                             ///< ground
  std::size_t emitters = 0;  ///< what is kept of each emitter: geometry and excess losses
  std::size_t total() const { return volumes + emitters; }
};

/// Computes the field of a scenario step by step; only what time or an edit of the scenario has invalidated
/// is computed. The volumes of an update equal, bit for bit, those of a new solver of the same snapshot,
/// except for the tolerance move_tolerance_m and while columns are interpolated (setTimeGoal()). One thread
/// calls it; it uses all threads that base/parallel.h allows.
class FieldSolver {
 public:
  /// @param terrain  null: no terrain in the scenario (smooth earth at mean sea level for `horizon`)
  /// @throws Error (bad_input) where the terrain is missing, naming the location, unless allowed; for
  /// values that a model refuses. Error (device) if a GPU is requested and there is none or it lacks memory
  FieldSolver(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
              FieldOptions options = {});
  ~FieldSolver();

  const volume::Grid& grid() const;
  const std::vector<Channel>& channels() const;
  /// Ground height above mean sea level under the centre of each column (m), i fastest; NaN over holes; empty
  /// without terrain. On a GPU the first call for a surface copies it from there: not from several threads.
  const std::vector<float>& groundHeights_m() const;

  /// Computes the field of a snapshot. If the snapshot's scenario is not the object of the last update, it is
  /// treated as an edited scenario: for each emitter the geometry is recomputed if its inputs have changed,
  /// else the combine stage, else only the products. If emitters are added or removed, the others, known by
  /// their names, keep their geometry; after a change of region or terrain everything is recomputed. Both
  /// need memory for two fields for a moment. A scenario must not be changed while a solver holds it.
  /// @param terrain  of the snapshot's scenario, loaded by the caller. A different object is treated as a
  /// different terrain
  /// @throws Error (bad_input) if terrain is missing, unless allowed, and as the constructor. The solver
  /// then still has the scenario of the last successful update, its channels and volumes, and the next update
  /// recomputes everything. After Error (device) volumes may be empty. Stopped, if the work of the calling
  /// thread is stopped (base/work.h): the same, but the next update keeps the geometry that is valid for it;
  /// volumes may be empty
  FieldChanged update(const scenario::Snapshot& snapshot, scenario::TerrainPtr terrain);
  /// The same with the solver's present terrain.
  /// @throws Error (bad_input) also if the snapshot's scenario names other elevation files
  FieldChanged update(const scenario::Snapshot& snapshot);

  /// Sets FieldOptions::quantities for the next update, which treats the scenario as edited; until then
  /// channels() and volumes() stay.
  /// @param next  scenario of the next update
  /// @throws Error (bad_input) as the constructor; nothing is changed then
  void setQuantities(std::vector<std::string> quantities, std::shared_ptr<const scenario::Scenario> next);
  /// Computes the field at a time with platforms at the poses that a program states, in place of their sites
  /// and tracks (emscape/scenario/model/poses.h): for hosts that move platforms themselves. Scenario and
  /// terrain are those of the last update. Poses are exact: what has moved at all is computed again, and the
  /// field is that of a scenario with fixed sites there.
  /// @throws as the others, and as scenario::snapshotAt()
  FieldChanged update(double time_s, const std::vector<scenario::PlatformPose>& poses);

  /// Time (ms) that an update should take while emitters move; 0, the default: every column is computed.
  /// If the columns of the emitters that moved take longer, by their last times, only every second or fourth
  /// column in each direction is computed, and the losses of the others are interpolated (columnStep()). The
  /// first update of an emitter computes all of them, and so do models that march outwards or have a
  /// reflected ray, surfaces, and on a GPU all models but `diffraction` and `horizon`. An update with 0
  /// completes what is interpolated.
  void setTimeGoal(double goal_ms);
  /// Of the last update: every step-th column in each direction is computed for all emitters; 1: every
  /// column.
  int columnStep() const;

  /// The channels' volumes after the last update, in the order of channels(), in the memory where they were
  /// computed: host or GPU. Later updates do not change them: a caller may keep one while the next is
  /// computed. info().range_* is the range of each volume, info().time_s the time of the last update. Empty
  /// handles before the first update.
  const std::vector<volume::Volume>& volumes() const;
  /// The columns of a channel's volume that are unknown to some of its emitters and have the value of the
  /// others (FieldOptions::keep_partly_unknown): 1, else 0; empty: none. Valid until the next update.
  const std::vector<std::uint8_t>& partlyUnknown(std::size_t channel) const;
  /// cpu or cuda.
  Backend backend() const;

  StageTimes stageTimes() const;
  MemoryUse memoryUse() const;
  /// Of the scenario with which the solver was constructed.
  MemoryEstimate memoryEstimate() const;
  /// Warnings about the current scenario so far, each once with its count: model limits exceeded, voxels in
  /// the near field, paths across holes of the terrain. Warnings of emitters that have been edited since are
  /// dropped. Of steep ground, those of the position where an emitter's marches lose most.
  /// @param steep  receives the marches over steep ground instead of the warnings, where the solver's field
  /// is one of several that an emitter is warned of together (steepGroundWarnings())
  std::vector<std::string> warnings(SteepGrounds* steep = nullptr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The grid of a scenario's region.
volume::Grid gridOf(const scenario::Region& region);

}  // namespace emscape::emfield
