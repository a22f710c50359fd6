/// The stages of the field on one backend: where their arrays live, and what runs over them.
///
/// FieldSolver decides what is computed anew and what is kept; an engine computes it. Emitters, channels and
/// slots are numbered by index.
#pragma once

#include <memory>
#include <vector>

#include "emfield/combine.h"
#include "emfield/grid_columns.h"
#include "emfield/products.h"
#include "emfield/solver/field_plan.h"
#include "emfield/terrain_fan.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/volume/volume.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// What a field is computed from. The base, FieldPlan, changes when the scenario is edited; the rest stays
/// the same as long as the engine lives.
struct FieldSetup : FieldPlan {
  scenario::TerrainPtr terrain;  ///< null: none
  volume::Grid grid;
  GridColumns columns;
  FanResolution resolution;
};

/// Stages 1 and 2 for one emitter, into a slot.
struct GeometryRequest {
  int emitter = 0;
  int slot = 0;
  scenario::EmitterState state;
};

/// What they found.
struct GeometryFindings {
  long long unknown_columns = 0;  ///< whose path crosses missing terrain
  std::vector<bool> unknown;      ///< which they are; empty: none
  unsigned remarks = 0;           ///< of the excess model: see remarkMessages()
  long long near_voxels = 0;      ///< nearer than the emitter's far field
};

/// One pass of stage 3.
struct CombinePass {
  struct Member {
    int slot = 0;
    /// Without the views of geometry and pattern, which are the engine's. Its shares are in the channels of
    /// the setup.
    CombineEmitter emitter;
    std::vector<RadarShare> radars;  ///< its parts in channels that take echoes
  };
  std::vector<Member> members;
  std::vector<bool> channels;  ///< those that take part
  bool into_resting = false;   ///< true: the sums of resting emitters, from nothing
  bool keep = false;  ///< true: goes on from what the sums hold; false: from the resting emitters' sums
};

/// Stage 4 for one channel.
struct VolumeRequest {
  int channel = 0;
  volume::VolumeInfo info;                                    ///< but for the value range
  const std::vector<std::uint16_t>* first_valid_k = nullptr;  ///< as in DenseVolume
};

class FieldEngine {
 public:
  virtual ~FieldEngine() = default;

  /// @return one a request, in their order
  virtual std::vector<GeometryFindings> computeGeometry(const std::vector<GeometryRequest>& requests) = 0;
  /// Which channels have sums of resting emitters from now on; a pass into them fills them.
  virtual void setResting(const std::vector<bool>& channels) = 0;
  virtual void combine(const CombinePass& pass) = 0;
  /// Makes new volumes of some channels where the engine computes; it reuses the memory of earlier ones that
  /// nobody holds any more.
  /// @return one per request, in their order
  virtual std::vector<volume::Volume> makeVolumes(const std::vector<VolumeRequest>& requests) = 0;

  /// The FieldPlan of the setup has changed. Slots stay valid.
  /// @param channels_changed  the sums of all channels are lost
  virtual void planChanged(bool channels_changed) = 0;

  /// Sets the stages' times to 0.
  virtual void resetTimes() = 0;
  virtual StageTimes times() = 0;
  /// Adds what the engine holds to total_bytes and to the bytes of voxels and channels.
  virtual void addMemory(MemoryUse& use) const = 0;
};

/// @param setup  must outlive the engine
/// @param slots  number of slots
std::unique_ptr<FieldEngine> makeCpuEngine(const FieldSetup& setup, int slots);

/// The same on the GPU. @throws Error (device)
std::unique_ptr<FieldEngine> makeCudaEngine(const FieldSetup& setup, int slots,
                                            volume::VoxelPrecision precision);

/// What the CUDA engine may take of the GPU's memory for fans while geometry is computed, and as much again
/// for models' own arrays (bytes).
constexpr std::size_t kDeviceScratchBytes = std::size_t{1} << 29;

/// Bytes of a terrain's posts.
std::size_t postBytes(const scenario::TerrainView& terrain);

/// Memory of the host that a CPU engine takes, at most.
/// @param slot_bytes  what the emitters keep
std::size_t cpuEngineBytes(const FieldSetup& setup, std::size_t slot_bytes);

/// Memory of the GPU that an engine takes there, at most.
/// @param slot_bytes  what the emitters keep
std::size_t cudaEngineBytes(const FieldSetup& setup, std::size_t slot_bytes,
                            volume::VoxelPrecision precision);

/// Value range of a volume in which nothing is above the floor: the floor.
inline void setRange(volume::VolumeInfo& info, const volume::ValueRange& range) {
  info.range_min = range.empty() ? info.floor : range.min;
  info.range_max = range.empty() ? info.floor : range.max;
}

/// Voxels of a column nearer to the emitter than a distance.
EMSCAPE_HD inline int nearVoxels(const ColumnGeometryView& geometry, std::size_t column, const float* t_m,
                                 int layers, float limit2_m2) {
  int count = 0;
  if (geometry.offset2_m2[column] >= limit2_m2) return count;
  for (int k = 0; k < layers; ++k) {
    const float along_m = t_m[k] - geometry.nearest_t_m[column];
    count += geometry.offset2_m2[column] + along_m * along_m < limit2_m2 ? 1 : 0;
  }
  return count;
}

}  // namespace emscape::emfield
