/// Frames of a source, computed ahead on a thread of its own, for a window whose time slider never waits.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "emscape/playback/clock.h"
#include "emscape/playback/frame_source.h"

namespace emscape::playback {

class FrameCache;

struct PrefetchOptions {
  std::size_t cache_bytes = std::size_t{1} << 30;  ///< of volumes; one frame is kept even if it is larger
  int steps_ahead = 4;  ///< so many after the requested one are computed without being asked for
  /// At least so long between the beginnings of two frames that are requested out of order (ms): of the many
  /// requests of a slider that is dragged, the last counts.
  double min_seek_interval_ms = 60;
};

/// A frame and its index in the source.
struct IndexedFrame {
  int index = 0;
  Frame frame;
};

/// Computes requested frames of a source and the ones after them, on one thread. There is one request at a
/// time: a new one replaces one that is not begun. Any thread calls the functions; none of them waits for a
/// frame, but for the destructor and those that say so.
class PrefetchingSource {
 public:
  /// @param source  frame() is called on the thread of this object alone; outlives this, as the clock
  /// @param ready   called on that thread after each frame, with its index, and once after a failure, with
  /// -1; may be
  ///                empty. Must not destroy this object
  PrefetchingSource(FrameSource& source, const PrefetchOptions& options, Clock& clock,
                    std::function<void(int index)> ready = {});
  /// Waits for the frame that is being computed; to shorten it, set the stop flag that the source was given.
  ~PrefetchingSource();
  PrefetchingSource(const PrefetchingSource&) = delete;
  PrefetchingSource& operator=(const PrefetchingSource&) = delete;

  /// Asks for a frame. @param index  0..count() - 1
  /// @throws what the source threw for an earlier request, once; that request is then over
  void request(int index);
  /// Asks for the frame nearest to a time. @return its index
  int requestTime(double time_s);
  /// The index asked for last; -1 before the first request and after a failure.
  int requested() const;

  /// What is to be shown: the requested frame if it is there, else the one that was requested before and is
  /// the newest. None before the first is there. @throws as request()
  std::optional<IndexedFrame> latest() const;
  /// Requests a frame and waits for it. @throws as request(); Error (other) if another thread requests
  /// another meanwhile
  Frame wait(int index);

  /// Indices of the frames that need not be computed, ascending.
  std::vector<int> cached() const;
  /// Frames computed so far.
  long long computed() const;

 private:
  void run();
  /// The frame to compute next; -1: none.
  int nextIndex() const;
  /// How soon a frame may be of use again: the smaller the sooner.
  long long distance(int index) const;
  void keep(int index, Frame frame);
  void rethrowFailure() const;

  FrameSource& source_;
  const PrefetchOptions options_;
  Clock& clock_;
  const std::function<void(int)> ready_;
  Event wake_;  // of the thread

  mutable std::mutex mutex_;
  std::condition_variable stored_;
  std::unique_ptr<FrameCache> cache_;
  int requested_ = -1;
  std::optional<IndexedFrame> latest_;
  long long computed_ = 0;
  bool closing_ = false;
  mutable std::exception_ptr failure_;  // not told yet

  std::thread thread_;
};

}  // namespace emscape::playback
