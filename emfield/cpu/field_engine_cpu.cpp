// The field's stages on the host.

#include <algorithm>
#include <atomic>
#include <optional>

#include "base/memory.h"
#include "base/stopwatch.h"
#include "emfield/cpu/look_weight_cache.h"
#include "emfield/solver/field_engine.h"
#include "emfield/solver/power_cache.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

/// Buffers of one channel.
struct ChannelBuffers {
  UnsetVector<float> value, second;                ///< accumulator over all emitters
  UnsetVector<float> static_value, static_second;  ///< accumulator over the static emitters
  std::vector<std::shared_ptr<volume::DenseVolume>> pool;
};

/// Whether paths are searched by sectors: all of surfaces, of volumes those of `horizon`.
bool needsBounds(const FieldSetup& setup) {
  if (setup.terrain == nullptr || setup.columns.tilted) return false;
  const auto& emitters = setup.scenario->emitters;
  return setup.columns.every_height ||
         std::any_of(emitters.begin(), emitters.end(), [](const scenario::Emitter& emitter) {
           return propagation::modelInfo(emitter.propagation.model).casts_shadow;
         });
}

class CpuEngine : public FieldEngine {
 public:
  CpuEngine(const FieldSetup& setup, int slots)
      : setup_(setup),
        voxels_(static_cast<std::size_t>(setup.grid.dims.count())),
        slots_(slots),
        kept_power_(static_cast<std::size_t>(std::max(0, slots - 1)), voxels_,
                    availableMemory_bytes().value_or(0)),
        kept_looks_(static_cast<std::size_t>(std::max(0, slots - 1)), voxels_,
                    availableMemory_bytes().value_or(0)) {
    planChanged(true);
    if (needsBounds(setup)) bounds_.emplace(setup.terrain->view());
    const Dims& dims = setup.grid.dims;
    const std::vector<std::uint16_t>& valid = setup.columns.first_valid_k;
    for (int j = 0; j < dims.y && !valid.empty(); ++j) {
      const auto row = valid.begin() + static_cast<std::ptrdiff_t>(j) * dims.x;
      first_row_k_.push_back(*std::min_element(row, row + dims.x));
    }
  }

  std::vector<GeometryResult> computeGeometry(const std::vector<GeometryRequest>& requests) override;
  void setStaticSums(const std::vector<bool>& channels) override;
  void combine(const CombinePass& pass) override;
  std::vector<volume::Volume> makeVolumes(const std::vector<VolumeRequest>& requests) override;
  void planChanged(bool channels_changed) final;
  void exchangeGeometry(int slot, FieldEngine& other, int other_slot) override;
  void resetTimes() override { times_ = {}; }
  StageTimes times() override { return times_; }
  void addMemory(MemoryUse& use) const override;

 private:
  /// The geometry of a slot is another one: what was computed from it is invalid.
  void forget(int slot) {
    kept_power_.forget(static_cast<std::size_t>(slot));
    kept_looks_.forget(static_cast<std::size_t>(slot));
  }
  bool hasSecond(std::size_t channel) const {
    return emfield::hasSecond(setup_.channel_plans[channel].reduction);
  }
  std::shared_ptr<volume::DenseVolume> freeVolume(ChannelBuffers& buffers) const;

  const FieldSetup& setup_;
  std::size_t voxels_;
  std::vector<int> first_row_k_;
  std::optional<TerrainBounds> bounds_;  // see needsBounds()
  std::vector<EmitterGeometry> slots_;
  PowerCache<std::vector<float>> kept_power_;  // except the last slot, which emitters share
  LookWeightCache kept_looks_;                 // the same
  std::vector<ChannelBuffers> buffers_;
  StageTimes times_;
};

std::vector<GeometryResult> CpuEngine::computeGeometry(const std::vector<GeometryRequest>& requests) {
  std::vector<GeometryResult> all;
  for (const GeometryRequest& request : requests) {
    EmitterGeometry& geometry = slots_[request.slot];
    forget(request.slot);
    EmitterGeometry::Times spent;
    geometry.compute(request.state, *setup_.scenario, setup_.scenario->emitters[request.emitter],
                     setup_.columns, setup_.terrain.get(), spent, bounds_ ? &*bounds_ : nullptr,
                     setup_.needs[request.emitter], request.part);
    times_.columns_ms += spent.columns_ms;
    times_.march_ms += spent.march_ms;
    times_.excess_ms += spent.excess_ms;
    times_.marched_heights += spent.marched_heights;

    GeometryResult found;
    found.unknown_columns = geometry.unknownColumns();
    found.warnings = geometry.warnings();
    found.steep = geometry.steep();
    found.column_step = geometry.columnStep();
    if (EmitterGeometry::interpolates(*setup_.scenario, setup_.scenario->emitters[request.emitter],
                                      setup_.columns, setup_.needs[request.emitter]))
      found.every_column_ms = spent.of_part_ms / request.part.fraction(setup_.grid.dims);
    if (found.unknown_columns > 0) {
      found.unknown.resize(setup_.columns.count());
      for (std::size_t c = 0; c < found.unknown.size(); ++c) found.unknown[c] = geometry.isUnknown(c) ? 1 : 0;
    }
    const ColumnGeometryView view = geometry.view();
    const std::vector<float>& t_m = setup_.columns.t_m;
    const double far_m = setup_.far_field_m[request.emitter];
    std::atomic<long long> near_voxels{0};
    parallelFor(static_cast<int>(setup_.columns.count()), 1 << 14, [&](int begin, int end) {
      long long of_part = 0;
      for (int c = begin; c < end; ++c) {
        of_part += nearVoxels(view, static_cast<std::size_t>(c), t_m.data(), static_cast<int>(t_m.size()),
                              static_cast<float>(far_m * far_m));
      }
      near_voxels += of_part;
    });
    found.near_voxels = near_voxels;
    all.push_back(std::move(found));
  }
  return all;
}

void CpuEngine::planChanged(bool channels_changed) {
  if (!channels_changed) return;
  buffers_ = std::vector<ChannelBuffers>(setup_.channels.size());
  for (std::size_t c = 0; c < buffers_.size(); ++c) {
    buffers_[c].value.resize(voxels_);
    if (hasSecond(c)) buffers_[c].second.resize(voxels_);
  }
}

void CpuEngine::exchangeGeometry(int slot, FieldEngine& other, int other_slot) {
  auto& engine = static_cast<CpuEngine&>(other);
  std::swap(slots_[slot], engine.slots_[other_slot]);
  forget(slot);
  engine.forget(other_slot);
}

void CpuEngine::setStaticSums(const std::vector<bool>& channels) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    ChannelBuffers& buffers = buffers_[c];
    buffers.static_value.resize(channels[c] ? voxels_ : 0);
    buffers.static_second.resize(channels[c] && hasSecond(c) ? voxels_ : 0);
    buffers.static_value.shrink_to_fit();
    buffers.static_second.shrink_to_fit();
  }
}

void CpuEngine::combine(const CombinePass& pass) {
  CombineTask task;
  task.dims = setup_.grid.dims;
  task.t_m = setup_.columns.t_m.data();
  task.first_row_k = first_row_k_.empty() ? nullptr : first_row_k_.data();
  task.keep = pass.keep;
  for (std::size_t c = 0; c < buffers_.size(); ++c) {
    ChannelBuffers& buffers = buffers_[c];
    auto& value = pass.into_static_sums ? buffers.static_value : buffers.value;
    auto& second = pass.into_static_sums ? buffers.static_second : buffers.second;
    const auto orNull = [](UnsetVector<float>& array) { return array.empty() ? nullptr : array.data(); };
    task.reductions.push_back(setup_.channel_plans[c].reduction);
    task.accumulators.push_back(pass.channels[c] ? Accumulator{orNull(value), orNull(second)}
                                                 : Accumulator{});
    task.initial.push_back(pass.into_static_sums ? ConstAccumulator{}
                                                 : ConstAccumulator{orNull(buffers.static_value),
                                                                    orNull(buffers.static_second)});
  }
  for (const CombinePass::Member& member : pass.members) {
    task.emitters.push_back(member.emitter);
    EmitterBeam& beam = task.emitters.back().beam;
    beam.geometry = slots_[member.slot].view();
    beam.pattern = member.beam_antenna->view();
    if (isIncluded(task, task.emitters.back()))
      kept_power_.choose(static_cast<std::size_t>(member.slot), member.beam_antenna, task.emitters.back());
  }
  Stopwatch watch;
  try {
    combineCpu(task);
    for (std::size_t m = 0; m < pass.members.size(); ++m) {
      const int slot = pass.members[m].slot;
      const scenario::AntennaPtr& antenna = pass.members[m].antenna;
      EmitterBeam beam = task.emitters[m].beam;
      beam.pattern = antenna->view();
      for (const RadarShare& share : pass.members[m].radars) {
        float* const accumulator = task.accumulators[share.channel].value;
        if (accumulator == nullptr) continue;
        const LookWeights weights = kept_looks_.choose(static_cast<std::size_t>(slot), antenna, share,
                                                       pass.members[m].radars.size() > 1);
        radarCpu(radarPass(share, beam, slots_[slot].clutterMap(), task, accumulator), weights);
      }
      for (const OccupancyShare& share : pass.members[m].occupancies) {
        float* const accumulator = task.accumulators[share.channel].value;
        if (accumulator != nullptr) occupancyCpu(occupancyPass(share, beam, task, accumulator));
      }
    }
  } catch (const Stopped&) {
    // What is kept of them may be unfinished.
    for (const CombinePass::Member& member : pass.members) forget(member.slot);
    throw;
  }
  times_.combine_ms += watch.lap_ms();
}

std::shared_ptr<volume::DenseVolume> CpuEngine::freeVolume(ChannelBuffers& buffers) const {
  for (const auto& candidate : buffers.pool) {
    if (candidate.use_count() == 1) return candidate;
  }
  buffers.pool.push_back(std::make_shared<volume::DenseVolume>());
  buffers.pool.back()->grid = setup_.grid;
  buffers.pool.back()->values.resize(voxels_);
  return buffers.pool.back();
}

std::vector<volume::Volume> CpuEngine::makeVolumes(const std::vector<VolumeRequest>& requests) {
  std::vector<volume::Volume> made;
  Stopwatch watch;
  for (const VolumeRequest& request : requests) {
    ChannelBuffers& buffers = buffers_[request.channel];
    const std::shared_ptr<volume::DenseVolume> volume = freeVolume(buffers);
    volume->first_valid_k = *request.first_valid_k;
    ProductTask task;
    task.dims = setup_.grid.dims;
    task.product = setup_.channel_plans[request.channel].product;
    task.accumulator = buffers.value.data();
    task.second = buffers.second.data();
    task.first_valid_k = volume->first_valid_k.empty() ? nullptr : volume->first_valid_k.data();
    task.values = volume->values.data();
    volume->info = request.info;
    setRange(volume->info, productCpu(task));
    made.emplace_back(volume);
  }
  times_.product_ms += watch.lap_ms();
  return made;
}

void CpuEngine::addMemory(MemoryUse& use) const {
  std::size_t channel_bytes = 0;
  for (const ChannelBuffers& buffers : buffers_) {
    for (const auto* buffer :
         {&buffers.value, &buffers.second, &buffers.static_value, &buffers.static_second}) {
      channel_bytes += buffer->capacity() * sizeof(float);
    }
    for (const auto& volume : buffers.pool) channel_bytes += volume->values.capacity() * sizeof(float);
  }
  use.bytes_per_voxel_and_channel = static_cast<double>(channel_bytes) / static_cast<double>(voxels_) /
                                    static_cast<double>(std::max<std::size_t>(1, buffers_.size()));
  use.total_bytes += channel_bytes + kept_power_.bytes() + kept_looks_.bytes();
  for (const EmitterGeometry& geometry : slots_) use.total_bytes += geometry.bytes();
}

}  // namespace

std::unique_ptr<FieldEngine> makeCpuEngine(const FieldSetup& setup, int slots) {
  return std::make_unique<CpuEngine>(setup, slots);
}

}  // namespace emscape::emfield
