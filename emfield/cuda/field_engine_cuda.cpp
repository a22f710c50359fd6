// The field's stages on one GPU.

#include <algorithm>
#include <map>

#include "emfield/cuda/combine_kernels.h"
#include "emfield/cuda/device_engine.h"
#include "emfield/cuda/device_geometry.h"
#include "emfield/solver/power_cache.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"

namespace emscape::emfield {
namespace {

using emscape::cuda::Buffer;
using emscape::cuda::check;
using volume::DeviceVolume;

/// The tables of an antenna's pattern on the device. One copy per antenna, also if emitters share it.
class DevicePattern {
 public:
  explicit DevicePattern(const scenario::PatternView& pattern) : view_(pattern) {
    using scenario::PatternKind;
    view_.azimuth_table = copied(pattern.azimuth_table, static_cast<std::size_t>(pattern.azimuth_count));
    view_.elevation_table =
        copied(pattern.elevation_table, static_cast<std::size_t>(pattern.elevation_count));
    view_.grid_table = copied(pattern.grid_table, static_cast<std::size_t>(pattern.columns) *
                                                      static_cast<std::size_t>(pattern.rows));
  }
  const scenario::PatternView& view() const { return view_; }

 private:
  const float* copied(const float* table, std::size_t count) {
    if (table == nullptr) return nullptr;
    tables_.emplace_back();
    tables_.back().upload(table, count);
    return tables_.back().data();
  }

  scenario::PatternView view_;
  std::vector<Buffer<float>> tables_;
};

/// Buffers of one channel.
struct ChannelBuffers {
  Buffer<float> value, second;                ///< accumulator over all emitters
  Buffer<float> static_value, static_second;  ///< accumulator over the static emitters alone
  Buffer<float> all_value, all_second;        ///< accumulator over the emitters of all engines
  volume::DeviceVolumeRing ring;
};

/// The tables to which a radar's contribution to a channel points.
struct RadarTables {
  Buffer<DetectionCurveView::Knot> knots;
  Buffer<float> blanked_probabilities;
  Buffer<JammerAtRadar> jammers;
  Buffer<LookArc> directions;
  Buffer<CountedArc> counts;
  Buffer<PassedArc> passes;
};

/// Copies of a beam's positions.
struct DevicePositions {
  Buffer<BeamArc> arcs;
  Buffer<float> cos_azimuth, sin_azimuth;
  Buffer<PatternReach> reaches;
};

class CudaEngine : public cuda::DeviceEngine {
 public:
  CudaEngine(const FieldSetup& setup, int slots, volume::VoxelPrecision precision);

  std::vector<GeometryResult> computeGeometry(const std::vector<GeometryRequest>& requests) override {
    for (const GeometryRequest& request : requests)
      kept_power_.forget(static_cast<std::size_t>(request.slot));
    return geometry_.compute(requests, stream_, clock_);
  }
  void setStaticSums(const std::vector<bool>& channels) override;
  void combine(const CombinePass& pass) override;
  std::vector<volume::Volume> makeVolumes(const std::vector<VolumeRequest>& requests) override;
  void planChanged(bool channels_changed) final;
  void setOthers(std::vector<cuda::DeviceEngine*> others) override { others_ = std::move(others); }
  void exchangeGeometry(int slot, FieldEngine& other, int other_slot) override {
    auto& engine = static_cast<CudaEngine&>(other);
    geometry_.exchange(slot, engine.geometry_, other_slot);
    kept_power_.forget(static_cast<std::size_t>(slot));
    engine.kept_power_.forget(static_cast<std::size_t>(other_slot));
  }
  void resetTimes() override { clock_.reset(); }
  StageTimes times() override { return clock_.times(); }
  void addMemory(MemoryUse& use) const override;

 private:
  ConstAccumulator sumsOfAll(std::size_t channel);
  const scenario::PatternView& patternOf(const scenario::AntennaPtr& antenna);
  bool hasSecond(std::size_t channel) const {
    return emfield::hasSecond(setup_.channel_plans[channel].reduction);
  }

  const FieldSetup& setup_;
  std::size_t voxels_;
  volume::VoxelPrecision precision_;
  /// Marches, on separate streams, do not delay it.
  emscape::cuda::Stream stream_{emscape::cuda::Stream::Priority::high};
  cuda::StageClock clock_;
  cuda::DeviceGeometry geometry_;
  PowerCache<Buffer<float>> kept_power_;                      // without the last slot, which emitters share
  std::map<scenario::AntennaPtr, DevicePattern> patterns_;    ///< of antennas and of their intervals
  std::map<std::pair<int, int>, RadarTables> radar_tables_;   ///< by channel and emitter
  std::map<std::pair<int, int>, DevicePositions> positions_;  ///< by channel and emitter
  std::vector<ChannelBuffers> buffers_;
  Buffer<cuda::DeviceRange> ranges_;
  int device_ = emscape::cuda::currentDevice();
  std::vector<cuda::DeviceEngine*> others_;
  Buffer<float> other_value_, other_second_;  ///< sums of another engine
  emscape::cuda::Event summed_;               ///< the sums are complete
  emscape::cuda::Event merged_;               ///< and were read by the engine of all
};

CudaEngine::CudaEngine(const FieldSetup& setup, int slots, volume::VoxelPrecision precision)
    : setup_(setup),
      voxels_(static_cast<std::size_t>(setup.grid.dims.count())),
      precision_(precision),
      geometry_(setup, slots),
      kept_power_(static_cast<std::size_t>(std::max(0, slots - 1)), voxels_, findDevice().free_bytes) {
  planChanged(true);
}

/// Copies the tables of a new antenna; frees those of antennas without other owners.
const scenario::PatternView& CudaEngine::patternOf(const scenario::AntennaPtr& antenna) {
  const auto known = patterns_.find(antenna);
  if (known != patterns_.end()) return known->second.view();
  for (auto it = patterns_.begin(); it != patterns_.end();) {
    it = it->first.use_count() == 1 ? patterns_.erase(it) : std::next(it);
  }
  return patterns_.emplace(antenna, DevicePattern(antenna->view())).first->second.view();
}

void CudaEngine::planChanged(bool channels_changed) {
  radar_tables_.clear();
  positions_.clear();
  if (!channels_changed) return;
  buffers_ = std::vector<ChannelBuffers>(setup_.channels.size());
  ranges_ = Buffer<cuda::DeviceRange>(setup_.channels.size());
  for (std::size_t c = 0; c < buffers_.size(); ++c) {
    buffers_[c].value.resize(voxels_);
    if (hasSecond(c)) buffers_[c].second.resize(voxels_);
  }
}

void CudaEngine::setStaticSums(const std::vector<bool>& channels) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    buffers_[c].static_value.resize(channels[c] ? voxels_ : 0);
    buffers_[c].static_second.resize(channels[c] && hasSecond(c) ? voxels_ : 0);
  }
}

void CudaEngine::combine(const CombinePass& pass) {
  CombineTask task;
  task.dims = setup_.grid.dims;
  task.t_m = geometry_.columns().t_m;
  task.keep = pass.keep;
  for (std::size_t c = 0; c < buffers_.size(); ++c) {
    ChannelBuffers& buffers = buffers_[c];
    auto& value = pass.into_static_sums ? buffers.static_value : buffers.value;
    auto& second = pass.into_static_sums ? buffers.static_second : buffers.second;
    task.reductions.push_back(setup_.channel_plans[c].reduction);
    task.accumulators.push_back(pass.channels[c] ? Accumulator{value.data(), second.data()} : Accumulator{});
    task.initial.push_back(pass.into_static_sums
                               ? ConstAccumulator{}
                               : ConstAccumulator{buffers.static_value.data(), buffers.static_second.data()});
  }
  for (const CombinePass::Member& member : pass.members) {
    task.emitters.push_back(member.emitter);
    EmitterBeam& beam = task.emitters.back().beam;
    beam.geometry = geometry_.view(member.slot);
    beam.pattern = patternOf(member.beam_antenna);
    if (isIncluded(task, task.emitters.back()))
      kept_power_.choose(static_cast<std::size_t>(member.slot), member.beam_antenna, task.emitters.back());
  }
  clock_.begin(stream_);
  cuda::combine(task, geometry_.firstValidK(), stream_);
  for (std::size_t m = 0; m < pass.members.size(); ++m) {
    if (pass.members[m].radars.empty() && pass.members[m].occupancies.empty()) continue;
    EmitterBeam beam = task.emitters[m].beam;
    beam.pattern = patternOf(pass.members[m].antenna);
    for (const RadarShare& share : pass.members[m].radars) {
      float* const accumulator = task.accumulators[share.channel].value;
      if (accumulator == nullptr) continue;
      RadarPass radar = radarPass(share, beam, geometry_.clutterMap(pass.members[m].slot), task, accumulator);
      RadarTables& tables = radar_tables_[{share.channel, pass.members[m].emitter.emitter_index}];
      if (tables.knots.size() == 0) {
        tables.knots.upload(share.task.curve.knots, static_cast<std::size_t>(share.task.curve.count),
                            stream_);
        const BlankedCurveView& blanked = share.task.blanker.curve;
        if (blanked.rows > 0) {
          tables.blanked_probabilities.upload(
              blanked.probabilities,
              static_cast<std::size_t>(blanked.rows) * BlankedCurveView::kVariances * blanked.count, stream_);
        }
      }
      radar.task.curve.knots = tables.knots.data();
      radar.task.blanker.curve.probabilities = tables.blanked_probabilities.data();
      radar.task.jammers = tables.jammers.send(share.jammers, stream_);
      radar.task.look_arcs = tables.directions.send(share.arcs.directions, stream_);
      radar.task.looks.arcs = tables.counts.send(share.arcs.counts, stream_);
      radar.task.last_passes.arcs = tables.passes.send(share.arcs.passes, stream_);
      cuda::addRadar(radar, geometry_.firstValidK(), stream_);
    }
    for (const OccupancyShare& share : pass.members[m].occupancies) {
      float* const accumulator = task.accumulators[share.channel].value;
      if (accumulator == nullptr) continue;
      OccupancyPass occupancy = occupancyPass(share, beam, task, accumulator);
      DevicePositions& positions = positions_[{share.channel, pass.members[m].emitter.emitter_index}];
      occupancy.arcs = positions.arcs.send(share.positions.arcs, stream_);
      occupancy.cos_azimuth = positions.cos_azimuth.send(share.positions.cos_azimuth, stream_);
      occupancy.sin_azimuth = positions.sin_azimuth.send(share.positions.sin_azimuth, stream_);
      occupancy.reaches = positions.reaches.send(share.positions.reaches, stream_);
      cuda::addOccupancy(occupancy, geometry_.firstValidK(), stream_);
    }
  }
  clock_.end(&StageTimes::combine_ms, stream_);
}

/// The sums of a channel over the emitters of all engines.
ConstAccumulator CudaEngine::sumsOfAll(std::size_t channel) {
  ChannelBuffers& buffers = buffers_[channel];
  ConstAccumulator sums{buffers.value.data(), buffers.second.data()};
  if (others_.empty()) return sums;
  const bool has_second = hasSecond(channel);
  const Accumulator all{buffers.all_value.atLeast(voxels_),
                        has_second ? buffers.all_second.atLeast(voxels_) : nullptr};
  const auto copy = [&](const Buffer<float>& from, Buffer<float>& to) {
    check(cudaMemcpyAsync(to.atLeast(voxels_), from.data(), voxels_ * sizeof(float), cudaMemcpyDefault,
                          stream_),
          "cudaMemcpyAsync between GPUs");
    return to.data();
  };
  for (cuda::DeviceEngine* const device_engine : others_) {
    auto& other = static_cast<CudaEngine&>(*device_engine);
    {
      const emscape::cuda::OnDevice there(other.device_);
      other.summed_.record(other.stream_);
    }
    other.summed_.holdBack(stream_);
    const ChannelBuffers& theirs = other.buffers_[channel];
    const ConstAccumulator more{copy(theirs.value, other_value_),
                                has_second ? copy(theirs.second, other_second_) : nullptr};
    merged_.record(stream_);
    merged_.holdBack(other.stream_);
    cuda::mergeSums(cuda::mergeOf(setup_.channel_plans[channel]), sums, more, all, voxels_, stream_);
    sums = {all.value, all.second};
  }
  return sums;
}

std::vector<volume::Volume> CudaEngine::makeVolumes(const std::vector<VolumeRequest>& requests) {
  if (requests.empty()) return {};
  std::vector<std::shared_ptr<DeviceVolume>> made;
  clock_.begin(stream_);
  const std::vector<cuda::DeviceRange> empty(requests.size());
  ranges_.upload(empty, stream_);
  for (std::size_t r = 0; r < requests.size(); ++r) {
    const VolumeRequest& request = requests[r];
    ChannelBuffers& buffers = buffers_[request.channel];
    const std::shared_ptr<DeviceVolume> volume = buffers.ring.next(setup_.grid, precision_);
    volume->info = request.info;
    volume->setMask(*request.first_valid_k);
    cuda::DeviceProductTask task;
    task.product = setup_.channel_plans[request.channel].product;
    const ConstAccumulator sums = sumsOfAll(static_cast<std::size_t>(request.channel));
    task.accumulator = sums.value;
    task.second = sums.second;
    task.first_valid_k = volume->storage().firstValidK();
    task.range = ranges_.data() + r;
    task.voxels = volume->storage().beginWriting(stream_);
    cuda::makeProduct(task, stream_);
    volume->storage().endWriting(stream_);
    made.push_back(volume);
  }
  clock_.end(&StageTimes::product_ms, stream_);
  std::vector<cuda::DeviceRange> ranges(requests.size());
  ranges_.download(ranges.data(), stream_);
  for (std::size_t r = 0; r < requests.size(); ++r) {
    setRange(made[r]->info, ranges[r].range(requests[r].info.floor));
  }
  return {made.begin(), made.end()};
}

void CudaEngine::addMemory(MemoryUse& use) const {
  std::size_t channel_bytes = 0;
  for (const ChannelBuffers& buffers : buffers_) {
    for (const auto* buffer : {&buffers.value, &buffers.second, &buffers.static_value, &buffers.static_second,
                               &buffers.all_value, &buffers.all_second}) {
      channel_bytes += buffer->size() * sizeof(float);
    }
    channel_bytes += volume::deviceBytes(setup_.grid.dims, precision_);
  }
  use.bytes_per_voxel_and_channel = static_cast<double>(channel_bytes) / static_cast<double>(voxels_) /
                                    static_cast<double>(std::max<std::size_t>(1, buffers_.size()));
  use.total_bytes += channel_bytes + geometry_.bytes() + kept_power_.bytes();
}

}  // namespace

std::unique_ptr<cuda::DeviceEngine> cuda::makeDeviceEngine(const FieldSetup& setup, int slots,
                                                           volume::VoxelPrecision precision) {
  return std::make_unique<CudaEngine>(setup, slots, precision);
}

}  // namespace emscape::emfield
