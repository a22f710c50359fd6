/// The stages of the field on one backend, with their arrays:
///
/// FieldSolver decides what is recomputed and what is kept; an engine computes it. Emitters, channels and
/// slots are numbered by index.
#pragma once

#include <memory>
#include <vector>

#include "emfield/channels/products.h"
#include "emfield/columns/column_part.h"
#include "emfield/columns/grid_columns.h"
#include "emfield/combine/combine.h"
#include "emfield/combine/occupancy.h"
#include "emfield/solver/field_plan.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/propagation/steep_ground.h"
#include "emscape/volume/volume.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// The inputs of a field. The base, FieldPlan, changes when the scenario is edited; the rest stays
/// the same as long as the engine lives.
struct FieldSetup : FieldPlan {
  scenario::TerrainPtr terrain;  ///< null: none
  volume::Grid grid;
  GridColumns columns;
};

/// Request to run stages 1 (columns) and 2 (excess) for one emitter; the results go into a slot.
struct GeometryRequest {
  int emitter = 0;
  int slot = 0;
  scenario::EmitterState state;
  /// The columns to compute, with one step for all requests; those that are known are in the slot, from the
  /// same inputs. An engine may compute all of them.
  ColumnPart part = {};
};

/// Findings of stages 1 and 2 for one emitter.
struct GeometryResult {
  long long unknown_columns = 0;                          ///< columns whose path crosses missing terrain
  std::vector<std::uint8_t> unknown;                      ///< one per column, 0 or 1; empty: none is unknown
  unsigned warnings = 0;                                  ///< of the excess model: see warningMessages()
  std::shared_ptr<const propagation::SteepGround> steep;  ///< EmitterExcess::steep
  long long near_voxels = 0;                              ///< voxels nearer than the emitter's far field
  int column_step = 1;  ///< every step-th column in each direction is computed, others are interpolated
  double every_column_ms = 0;  ///< time that every column would take, of the part that can be left out
};

/// One pass of stage 3.
struct CombinePass {
  struct Member {
    int slot = 0;
    scenario::AntennaPtr antenna;       ///< the emitter's own: of radars' echoes and of occupancy
    scenario::AntennaPtr beam_antenna;  ///< of the beam's pattern, which may be that of an interval
    /// Without the views of geometry and pattern, which belong to the engine. Channels are those of the
    /// setup.
    CombineEmitter emitter;
    std::vector<RadarShare> radars;           ///< its contributions to channels of echoes
    std::vector<OccupancyShare> occupancies;  ///< its contributions to channels of occupancy
  };
  std::vector<Member> members;
  std::vector<bool> channels;     ///< true for those of the pass
  bool into_static_sums = false;  ///< true: computes the sums of static emitters from their initial values
  bool keep =
      false;  ///< true: continues with the present sums; false: starts from the sums of static emitters
};

/// Stage 4 for one channel.
struct VolumeRequest {
  int channel = 0;
  volume::VolumeInfo info;                                    ///< without the value range
  const std::vector<std::uint16_t>* first_valid_k = nullptr;  ///< as in DenseVolume
};

class FieldEngine {
 public:
  virtual ~FieldEngine() = default;

  /// @return one per request, in their order
  virtual std::vector<GeometryResult> computeGeometry(const std::vector<GeometryRequest>& requests) = 0;
  /// Sets which channels have separate sums of static emitters; a pass into them fills them.
  virtual void setStaticSums(const std::vector<bool>& channels) = 0;
  virtual void combine(const CombinePass& pass) = 0;
  /// Makes new volumes of some channels in the engine's memory (host or GPU); reuses the memory of earlier
  /// ones that are released.
  /// @return one per request, in their order
  virtual std::vector<volume::Volume> makeVolumes(const std::vector<VolumeRequest>& requests) = 0;

  /// The FieldPlan of the setup has changed. Slots stay valid.
  /// @param channels_changed  the sums of all channels are lost
  virtual void planChanged(bool channels_changed) = 0;
  /// Exchanges the geometry of a slot with that of another engine of the same backend, grid and terrain.
  virtual void exchangeGeometry(int slot, FieldEngine& other, int other_slot) = 0;

  /// Sets the stages' times to 0.
  virtual void resetTimes() = 0;
  virtual StageTimes times() = 0;
  /// Adds the engine's memory to total_bytes and to the bytes of voxels and channels.
  virtual void addMemory(MemoryUse& use) const = 0;
};

/// The columns of a surface, computed on the GPU and kept there: for models that do not need them on the host
/// (needsHostColumns()). @throws Error (device), or (bad_input) as makeGridColumns()
GridColumns makeDeviceColumns(const Surface& surface, const scenario::Terrain* terrain);
/// Copies the ground below such columns (GridColumns::ground_msl_m). @throws Error (device)
std::vector<float> groundOf(const cuda::DevicePositions& positions);

/// @param setup  must outlive the engine
/// @param slots  number of slots
std::unique_ptr<FieldEngine> makeCpuEngine(const FieldSetup& setup, int slots);

/// The same on the GPU. @throws Error (device)
std::unique_ptr<FieldEngine> makeCudaEngine(const FieldSetup& setup, int slots,
                                            volume::VoxelPrecision precision);

/// Limit (bytes) of the CUDA engine's memory for profiles while geometry is computed.
constexpr std::size_t kDeviceScratchBytes = std::size_t{1} << 30;

/// Bytes of a terrain's posts.
std::size_t postBytes(const scenario::TerrainView& terrain);

/// Upper bound of the host memory of a CPU engine, without the columns.
/// @param slot_bytes  bytes cached for the emitters
std::size_t cpuEngineBytes(const FieldSetup& setup, std::size_t slot_bytes);

/// Upper bound of the GPU memory of a CUDA engine, without the columns.
/// @param slot_bytes  bytes cached for the emitters
std::size_t cudaEngineBytes(const FieldSetup& setup, std::size_t slot_bytes,
                            volume::VoxelPrecision precision);

/// Sets the value range of a volume; the floor if nothing is above it.
inline void setRange(volume::VolumeInfo& info, const volume::ValueRange& range) {
  info.range_min = range.empty() ? info.floor : range.min;
  info.range_max = range.empty() ? info.floor : range.max;
}

/// Number of voxels of a column closer to the emitter than a distance.
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
