/// Frames by their index, with a limit of memory. Internal to the module.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "emscape/playback/frames/frame_source.h"

namespace emscape::playback {

/// For one thread at a time.
class FrameCache {
 public:
  /// Distance of a frame from the next expected one; the frame with the largest is dropped first.
  using Distance = std::function<long long(int index)>;

  /// @param max_bytes  of volumes; one frame is kept even if it is larger
  explicit FrameCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Null if the frame is not cached.
  const Frame* find(int index) const;
  /// Adds a frame; drops those with the largest distance to stay within the limit.
  void keep(int index, Frame frame, const Distance& distance);
  /// True if a frame would be kept: there is memory, or a frame with a larger distance.
  bool wouldKeep(int index, const Distance& distance) const;
  /// Ascending.
  std::vector<int> indices() const;
  void clear() { frames_.clear(); }

 private:
  std::size_t bytes() const;

  const std::size_t max_bytes_;
  std::map<int, Frame> frames_;
  std::size_t frame_bytes_ = 0;  // of the largest so far
};

}  // namespace emscape::playback
