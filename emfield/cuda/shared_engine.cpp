// The field on the GPUs of a host: emitters are shared out, each GPU sums those of its own, and the first one
// makes the volumes from all sums.

#include <algorithm>
#include <functional>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/device_engine.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using cuda::DeviceEngine;
using emscape::cuda::OnDevice;

/// The GPU of a number: in turn, from one that a hash of the round gives, so that emitters that cost more
/// than others are shared out also where they stand in a regular order.
int deviceFor(int number, int devices) {
  const unsigned round = static_cast<unsigned>(number / devices) * 2654435769U;
  return (number + static_cast<int>(round >> 16)) % devices;
}

class SharedEngine : public FieldEngine {
 public:
  SharedEngine(const FieldSetup& setup, int devices, int slots, volume::VoxelPrecision precision)
      : own_slots_(slots - 1) {
    for (int device = 0; device < devices; ++device) {
      const OnDevice here(device);
      engines_.push_back(cuda::makeDeviceEngine(setup, slots, precision));
    }
    for (int slot = 0; slot < own_slots_; ++slot) device_of_slot_.push_back(deviceFor(slot, devices));
    std::vector<DeviceEngine*> others;
    for (int device = 1; device < devices; ++device) {
      cudaDeviceEnablePeerAccess(device, 0);  // without it copies pass through the host
      cudaGetLastError();                     // also of a second call
      others.push_back(engines_[static_cast<std::size_t>(device)].get());
    }
    engines_.front()->setOthers(std::move(others));
  }

  std::vector<GeometryResult> computeGeometry(const std::vector<GeometryRequest>& requests) override {
    std::vector<GeometryResult> results(requests.size());
    onEach([&](int device, DeviceEngine& engine) {
      std::vector<GeometryRequest> own;
      std::vector<std::size_t> numbers;
      for (std::size_t r = 0; r < requests.size(); ++r) {
        if (deviceOf(requests[r].slot, requests[r].emitter) != device) continue;
        own.push_back(requests[r]);
        numbers.push_back(r);
      }
      if (own.empty()) return;
      std::vector<GeometryResult> found = engine.computeGeometry(own);
      for (std::size_t i = 0; i < found.size(); ++i) {
        found[i].every_column_ms /= static_cast<double>(engines_.size());  // at the same time as the others
        results[numbers[i]] = std::move(found[i]);
      }
    });
    return results;
  }
  void setStaticSums(const std::vector<bool>& channels) override {
    onEach([&](int, DeviceEngine& engine) { engine.setStaticSums(channels); });
  }
  void combine(const CombinePass& pass) override {
    onEach([&](int device, DeviceEngine& engine) {
      CombinePass own{{}, pass.channels, pass.into_static_sums, pass.keep};
      for (const CombinePass::Member& member : pass.members) {
        if (deviceOf(member.slot, member.emitter.emitter_index) == device) own.members.push_back(member);
      }
      engine.combine(own);
    });
  }
  std::vector<volume::Volume> makeVolumes(const std::vector<VolumeRequest>& requests) override {
    return engines_.front()->makeVolumes(requests);
  }
  void planChanged(bool channels_changed) override {
    onEach([&](int, DeviceEngine& engine) { engine.planChanged(channels_changed); });
  }
  void exchangeGeometry(int slot, FieldEngine& other, int other_slot) override {
    auto& shared = static_cast<SharedEngine&>(other);
    int& device = device_of_slot_[static_cast<std::size_t>(slot)];
    int& other_device = shared.device_of_slot_[static_cast<std::size_t>(other_slot)];
    exchangeOn(device, slot, shared, other_slot);
    if (other_device != device) exchangeOn(other_device, slot, shared, other_slot);
    std::swap(device, other_device);
  }
  void resetTimes() override {
    onEach([](int, DeviceEngine& engine) { engine.resetTimes(); });
  }
  /// Of each stage those of the slowest GPU.
  StageTimes times() override {
    StageTimes slowest;
    for (const auto& engine : engines_) {
      const StageTimes times = engine->times();
      for (double StageTimes::*const stage :
           {&StageTimes::columns_ms, &StageTimes::march_ms, &StageTimes::excess_ms, &StageTimes::combine_ms,
            &StageTimes::product_ms}) {
        slowest.*stage = std::max(slowest.*stage, times.*stage);
      }
      slowest.marched_heights += times.marched_heights;
    }
    return slowest;
  }
  void addMemory(MemoryUse& use) const override {
    double most = 0;
    for (const auto& engine : engines_) {
      engine->addMemory(use);
      most = std::max(most, use.bytes_per_voxel_and_channel);
    }
    use.bytes_per_voxel_and_channel = most;
  }

 private:
  /// @param emitter  decides for the slot that emitters share
  int deviceOf(int slot, int emitter) const {
    return slot < own_slots_ ? device_of_slot_[static_cast<std::size_t>(slot)]
                             : deviceFor(emitter, static_cast<int>(engines_.size()));
  }
  void onEach(const std::function<void(int device, DeviceEngine& engine)>& body) {
    parallelFor(static_cast<int>(engines_.size()), 1, [&](int begin, int end) {
      for (int device = begin; device < end; ++device) {
        const OnDevice here(device);
        body(device, *engines_[static_cast<std::size_t>(device)]);
      }
    });
  }
  void exchangeOn(int device, int slot, SharedEngine& other, int other_slot) {
    engines_[static_cast<std::size_t>(device)]->exchangeGeometry(
        slot, *other.engines_[static_cast<std::size_t>(device)], other_slot);
  }

  int own_slots_;                                       ///< of one emitter each; one more is shared
  std::vector<std::unique_ptr<DeviceEngine>> engines_;  ///< one per GPU
  std::vector<int> device_of_slot_;
};

}  // namespace

std::unique_ptr<FieldEngine> makeCudaEngine(const FieldSetup& setup, int slots,
                                            volume::VoxelPrecision precision) {
  const int devices = std::min(deviceCount(), std::max(1, slots - 1));
  // Columns that only the first GPU has are not shared out.
  if (devices == 1 || setup.columns.on_device != nullptr) {
    return cuda::makeDeviceEngine(setup, slots, precision);
  }
  return std::make_unique<SharedEngine>(setup, devices, slots, precision);
}

}  // namespace emscape::emfield
