/// Scenario and time to volumes: the pipeline fan -> plane -> combine -> product, with its caches.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/backend.h"
#include "emscape/base/progress.h"
#include "emscape/emfield/quantities.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/device_volume.h"

namespace emscape::emfield {

/// What one volume of the output holds.
struct Channel {
  Quantity quantity = Quantity::power_density_dbwm2;
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
  Backend backend = Backend::cpu;  ///< automatic: the GPU if it has the memory, else the CPU
  /// cuda: how volumes are kept. float16 takes less memory.
  volume::VoxelPrecision device_precision = volume::VoxelPrecision::float32;
  /// An emitter that moved less than this keeps its fan and planes (m).
  double move_tolerance_m = 0.5;
  /// Bound on the per-emitter caches (bytes, of the GPU's memory with cuda), 0: none. Emitters that do not
  /// fit are computed anew at each update.
  std::size_t cache_bytes = 0;
};

/// What an update did. A frame controller counts `any` as one event.
struct FieldChanged {
  bool any = false;
  bool grid = false;        ///< first update: everything is new
  std::vector<int> moved;   ///< emitters whose fan and planes were computed anew
  std::vector<int> turned;  ///< emitters of which only the beam, the power or the activity changed
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

/// Computes the field of a scenario step by step; only what changed since the last update is computed.
/// One thread calls it; it uses all threads that base/parallel.h allows.
class FieldSolver {
 public:
  /// @param terrain  null: no terrain in the scenario (smooth earth at mean sea level for `horizon`)
  /// @throws Error (bad_input) where the terrain is missing, naming the place, unless allowed; for a model
  /// that is not built
  FieldSolver(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
              FieldOptions options);
  ~FieldSolver();

  const volume::Grid& grid() const;
  const std::vector<Channel>& channels() const;
  /// Ground height above mean sea level under the centre of each column (m), i fastest; NaN over holes; empty
  /// without terrain.
  const std::vector<float>& groundHeights_m() const;

  /// Computes the field of a snapshot of the same scenario.
  /// @throws Error (bad_input) where a path crosses missing terrain, unless allowed; the solver must not be
  /// used after that
  FieldChanged update(const scenario::Snapshot& snapshot);

  /// The channels' volumes after the last update, in the order of channels(). They are not changed by later
  /// updates: a caller may keep one while the next is computed. info.range_* are this volume's own; a series
  /// sets them for all. With cuda they are copied from the GPU when this is called.
  const std::vector<std::shared_ptr<const volume::DenseVolume>>& volumes() const;

  /// The same volumes where a GPU computed them, without a copy through the host; empty with the CPU. They
  /// are not changed by later updates either.
  const std::vector<std::shared_ptr<const volume::DeviceVolume>>& deviceVolumes() const;
  /// cpu or cuda.
  Backend backend() const;

  StageTimes stageTimes() const;
  MemoryUse memoryUse() const;
  /// Warnings so far, each once with its count: model limits exceeded, near field, holes crossed.
  std::vector<std::string> warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The grid of a scenario's region.
volume::Grid gridOf(const scenario::Region& region);

}  // namespace emscape::emfield
