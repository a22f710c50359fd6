#include "playback/frames/frame_cache.h"

#include <algorithm>

namespace emscape::playback {
namespace {

std::size_t bytesOf(const Frame& frame) {
  constexpr std::size_t kValueBytes = 4;
  if (frame.cells) return frame.cells->field.values.size() * kValueBytes;  // the mesh is shared
  return static_cast<std::size_t>(frame.grid().dims.count()) * kValueBytes;
}

}  // namespace

const Frame* FrameCache::find(int index) const {
  const auto found = frames_.find(index);
  return found == frames_.end() ? nullptr : &found->second;
}

void FrameCache::keep(int index, Frame frame, const Distance& distance) {
  frame_bytes_ = std::max(frame_bytes_, bytesOf(frame));
  frames_.insert_or_assign(index, std::move(frame));
  while (frames_.size() > 1 && bytes() > max_bytes_) {
    frames_.erase(std::max_element(frames_.begin(), frames_.end(), [&](const auto& a, const auto& b) {
      return distance(a.first) < distance(b.first);
    }));
  }
}

bool FrameCache::wouldKeep(int index, const Distance& distance) const {
  if (bytes() + frame_bytes_ <= max_bytes_) return true;
  return std::any_of(frames_.begin(), frames_.end(),
                     [&](const auto& kept) { return distance(kept.first) > distance(index); });
}

std::vector<int> FrameCache::indices() const {
  std::vector<int> indices;
  for (const auto& [index, frame] : frames_) indices.push_back(index);
  return indices;
}

std::size_t FrameCache::bytes() const {
  std::size_t bytes = 0;
  for (const auto& [index, frame] : frames_) bytes += bytesOf(frame);
  return bytes;
}

}  // namespace emscape::playback
