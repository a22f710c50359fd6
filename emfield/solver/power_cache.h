/// Cache of the power densities of emitters that do not change while others do.
#pragma once

#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include "emfield/combine/combine.h"

namespace emscape::emfield {

/// True if two emitters with the same geometry have the same power density everywhere.
bool samePower(const scenario::AntennaPtr& antenna_a, const EmitterBeam& a,
               const scenario::AntennaPtr& antenna_b, const EmitterBeam& b);

/// Limit (bytes) of a cache: an eighth of the available memory, at most 1 GiB.
constexpr std::size_t keptBytes(std::size_t available_bytes) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  constexpr std::size_t kPartOfMemory = 8;
  const std::size_t bytes = available_bytes / kPartOfMemory;
  return bytes < kMaxBytes ? bytes : kMaxBytes;
}

/// An emitter that is unchanged in a second sum is computed once more and stored; afterwards it is read,
/// which is many times faster and bit-identical.
/// @tparam Array  of floats: std::vector<float> or a GPU's buffer
template <class Array>
class PowerCache {
 public:
  /// @param slots            emitters with their own geometry
  /// @param voxels           of the grid
  /// @param available_bytes  keptBytes() of it are used
  PowerCache(std::size_t slots, std::size_t voxels, std::size_t available_bytes)
      : voxels_(voxels),
        limit_(keptBytes(available_bytes) / (sizeof(float) * (voxels > 0 ? voxels : 1))),
        slots_(slots) {}

  /// Sets the array to which the next pass writes, or from which it reads, the power of an emitter. The pass
  /// must be run with the emitter in it (isIncluded()), otherwise the array is never written.
  /// @param slot     of the emitter; others than those of the constructor are never stored
  /// @param antenna  of the emitter
  /// @param emitter  its beam is complete; power_wm2 and power_is_known are set
  void choose(std::size_t slot, const scenario::AntennaPtr& antenna, CombineEmitter& emitter) {
    if (slot >= slots_.size()) return;
    Slot& kept = slots_[slot];
    if (!kept.antenna || !samePower(kept.antenna, kept.beam, antenna, emitter.beam)) {
      forget(slot);
      kept.antenna = antenna;
      kept.beam = emitter.beam;
      return;
    }
    emitter.power_is_known = kept.is_known;
    if (!kept.is_known && !take(kept)) return;
    kept.is_known = true;
    emitter.power_wm2 = kept.power_wm2.data();
  }
  /// The geometry of a slot has changed.
  void forget(std::size_t slot) {
    if (slot >= slots_.size()) return;
    if (slots_[slot].is_known) free_.push_back(std::move(slots_[slot].power_wm2));
    slots_[slot] = {};
  }
  std::size_t bytes() const { return taken_ * voxels_ * sizeof(float); }

 private:
  struct Slot {
    scenario::AntennaPtr antenna;  ///< null: has not entered a sum
    EmitterBeam beam;
    Array power_wm2;
    bool is_known = false;
  };

  /// @return false if there is no memory for another one
  bool take(Slot& slot) {
    if (!free_.empty()) {
      slot.power_wm2 = std::move(free_.back());
      free_.pop_back();
      return true;
    }
    if (taken_ >= limit_) return false;
    try {
      slot.power_wm2.resize(voxels_);
    } catch (const std::exception&) {  // the memory is no longer available
      limit_ = taken_;
      return false;
    }
    ++taken_;
    return true;
  }

  std::size_t voxels_;
  std::size_t limit_;      // of taken_
  std::size_t taken_ = 0;  // arrays
  std::vector<Slot> slots_;
  std::vector<Array> free_;
};

}  // namespace emscape::emfield
