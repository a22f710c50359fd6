/// Scenario and time to volumes: the pipeline fan -> excess -> combine -> product, with its caches.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/scenario/quantities.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/volume/device_volume.h"
#include "emscape/volume/volume.h"

namespace emscape::emfield {

/// What one volume of the output holds.
struct Channel {
  scenario::Quantity quantity = scenario::Quantity::power_density_dbwm2;
  std::string name;  ///< quantity, with ":" and the emitter's or band's name where it is not the sum of all
  std::vector<int> emitters;      ///< indices that enter it
  std::vector<int> jammers = {};  ///< indices of those that jam them, where jamming counts
};

/// The channels of a scenario's output: one a quantity, or one a quantity and emitter (combine per_emitter)
/// or band.
/// @param quantities  names; empty: the scenario's own
/// @throws Error (bad_input)
std::vector<Channel> channelsOf(const scenario::Scenario& scenario,
                                const std::vector<std::string>& quantities);

struct FieldOptions {
  std::vector<std::string> quantities;  ///< empty: the scenario's
  bool allow_missing_terrain =
      false;  ///< true: columns over holes, and those that are seen only across one, are masked
  Backend backend = Backend::cpu;  ///< automatic: the GPU if there is one with the memory, else the CPU
  /// cuda: how volumes are kept. float16 takes less memory.
  volume::VoxelPrecision device_precision = volume::VoxelPrecision::float32;
  /// An emitter that moved less than this as time went on keeps its geometry (m). Edits count to the last
  /// bit.
  double move_tolerance_m = 0.5;
  /// Bound on the per-emitter caches (bytes, of the GPU's memory with cuda), 0: none. Emitters that do not
  /// fit are computed anew at each update.
  std::size_t cache_bytes = 0;
};

/// What an update did. A frame controller counts `any` as one event.
struct FieldChanged {
  bool any = false;
  bool grid = false;      ///< everything is new: the first update, or another region, terrain or emitter list
  bool channels = false;  ///< channels() may be others than before
  std::vector<int> moved;    ///< emitters whose geometry (fan and excess losses) was computed anew
  std::vector<int> turned;   ///< emitters of which only the beam, the power or the activity changed, or what
                             ///< else the combine stage reads
  std::vector<int> volumes;  ///< channels whose volume was computed anew
};

/// Milliseconds that the stages of the last update took; with cuda on the GPU.
struct StageTimes {
  double fan_ms = 0, plane_ms = 0, combine_ms = 0, product_ms = 0;
};

struct MemoryUse {
  double bytes_per_voxel_and_emitter = 0;   ///< excess losses, mean over the emitters
  double bytes_per_column_and_emitter = 0;  ///< geometry cache
  double bytes_per_voxel_and_channel = 0;   ///< sums and output
  std::size_t total_bytes = 0;
  int uncached_emitters = 0;
};

/// Computes the field of a scenario step by step; only what time or an edit of the scenario has invalidated
/// is computed. The volumes of an update equal, bit for bit, those of a new solver of the same snapshot, but
/// for what move_tolerance_m allows. One thread calls it; it uses all threads that base/parallel.h allows.
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
  /// without terrain.
  const std::vector<float>& groundHeights_m() const;

  /// Computes the field of a snapshot. If the snapshot's scenario is another object than that of the last
  /// update, it counts as an edited scenario: per emitter the geometry is computed anew where what it depends
  /// on has changed, else the combine stage, else the products alone. Another region, terrain or list of
  /// emitters makes everything anew, for which the memory of both fields is needed for a moment. A scenario
  /// must not be changed in place while a solver has it.
  /// @param terrain  of the snapshot's scenario; the caller loads it. Another object than before counts as
  /// another terrain
  /// @throws Error (bad_input) where terrain is missing, unless allowed, and as the constructor. The solver
  /// then still has the scenario of the last successful update, its channels and volumes, and the next update
  /// computes everything anew. After Error (device) volumes may be empty
  FieldChanged update(const scenario::Snapshot& snapshot, scenario::TerrainPtr terrain);
  /// The same with the terrain that the solver has.
  /// @throws Error (bad_input) also if the snapshot's scenario names other elevation files
  FieldChanged update(const scenario::Snapshot& snapshot);

  /// The channels' volumes after the last update, in the order of channels(), where they were computed: in
  /// the host's memory or on the GPU. Later updates do not change them: a caller may keep one while the next
  /// is computed. info().range_* are each volume's own; a series sets them for all. A volume that time did
  /// not change keeps the time at which it was computed. Empty handles before the first update.
  const std::vector<volume::Volume>& volumes() const;
  /// cpu or cuda.
  Backend backend() const;

  StageTimes stageTimes() const;
  MemoryUse memoryUse() const;
  /// Warnings on the current scenario so far, each once with its count: model limits exceeded, near field,
  /// holes crossed. Those of emitters that were edited since are dropped.
  std::vector<std::string> warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The grid of a scenario's region.
volume::Grid gridOf(const scenario::Region& region);

}  // namespace emscape::emfield
