/// Data of steps by their index, with a limit of memory. Internal to the module.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "emscape/playback/frames/frame_source.h"

namespace emscape::playback {

/// Bytes of the values.
inline std::size_t bytesOf(const volume::Volume& volume) {
  return static_cast<std::size_t>(volume.grid().dims.count()) * sizeof(float);
}
inline std::size_t bytesOf(const std::vector<volume::Volume>& volumes) {
  std::size_t bytes = 0;
  for (const volume::Volume& volume : volumes) bytes += bytesOf(volume);
  return bytes;
}
inline std::size_t bytesOf(const Frame& frame) {
  return frame.cells ? frame.cells->field.values.size() * sizeof(float)  // the mesh is shared
                     : bytesOf(frame.volume);
}

/// For one thread at a time.
/// @tparam Data  has a function bytesOf()
template <class Data>
class StepCache {
 public:
  /// Distance of a step from the next expected one; the step with the largest is dropped first.
  using Distance = std::function<long long(int index)>;

  /// @param max_bytes  of all steps; one is kept even if it is larger
  explicit StepCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Null if the step is not cached.
  const Data* find(int index) const {
    const auto found = steps_.find(index);
    return found == steps_.end() ? nullptr : &found->second;
  }
  /// Adds a step; drops those with the largest distance to stay within the limit.
  void keep(int index, Data data, const Distance& distance) {
    step_bytes_ = std::max(step_bytes_, bytesOf(data));
    steps_.insert_or_assign(index, std::move(data));
    while (steps_.size() > 1 && bytes() > max_bytes_) {
      steps_.erase(std::max_element(steps_.begin(), steps_.end(), [&](const auto& a, const auto& b) {
        return distance(a.first) < distance(b.first);
      }));
    }
  }
  /// True if a step would be kept: there is memory, or a step with a larger distance.
  bool wouldKeep(int index, const Distance& distance) const {
    if (bytes() + step_bytes_ <= max_bytes_) return true;
    return std::any_of(steps_.begin(), steps_.end(),
                       [&](const auto& kept) { return distance(kept.first) > distance(index); });
  }
  /// Sets another limit; keep() applies it.
  void setLimit(std::size_t max_bytes) { max_bytes_ = max_bytes; }
  /// Ascending.
  std::vector<int> indices() const {
    std::vector<int> indices;
    for (const auto& [index, data] : steps_) indices.push_back(index);
    return indices;
  }
  void clear() { steps_.clear(); }
  /// Of all steps.
  std::size_t bytes() const {
    std::size_t bytes = 0;
    for (const auto& [index, data] : steps_) bytes += bytesOf(data);
    return bytes;
  }

 private:
  std::size_t max_bytes_;
  std::map<int, Data> steps_;
  std::size_t step_bytes_ = 0;  // of the largest so far
};

}  // namespace emscape::playback
