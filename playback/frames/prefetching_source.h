/// Frames of a source, computed ahead on a separate thread, so that the time slider of a window never waits.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/clock.h"

namespace emscape::playback {

class FrameCache;

struct PrefetchOptions {
  std::size_t cache_bytes = std::size_t{1} << 30;  ///< of volumes; one frame is kept even if it is larger
  int steps_ahead = 4;                             ///< number of frames computed after the requested one
  /// Minimum interval (ms) between the starts of two frames that are requested out of order, for example by
  /// dragging a slider. Only the last request is served.
  double min_seek_interval_ms = 60;
};

/// A frame and its index in the source.
struct IndexedFrame {
  int index = 0;
  Frame frame;
};

/// Computes requested frames of a source and the ones after them, on one thread. There is one request at a
/// time: a new one replaces a pending one. Any thread may call the functions; none waits for a frame, except
/// the destructor and where stated.
class PrefetchingSource {
 public:
  /// @param source  frame() is called only on the thread of this object; must outlive this object, as must
  /// the clock
  /// @param ready called on that thread after each frame, with its index, or -1 after a failure; may be
  /// empty. It must not destroy this object
  PrefetchingSource(FrameSource& source, const PrefetchOptions& options, Clock& clock,
                    std::function<void(int index)> ready = {});
  /// Waits for the frame in progress; to shorten the wait, set the source's stop flag first.
  ~PrefetchingSource();
  PrefetchingSource(const PrefetchingSource&) = delete;
  PrefetchingSource& operator=(const PrefetchingSource&) = delete;

  /// Requests a frame. @param index  0..count() - 1
  /// @throws the source's exception for an earlier request, once; that request is then discarded
  void request(int index);
  /// Requests the frame nearest to a time. @return its index
  int requestTime(double time_s);
  /// The last requested index; -1 before the first request and after a failure.
  int requested() const;

  /// The frame to show: the requested one if it is ready, else the newest one that was requested before.
  /// Empty before the first is ready. @throws as request()
  std::optional<IndexedFrame> latest() const;
  /// Requests a frame and waits for it. @throws as request(); Error (other) if another thread requests a
  /// different frame meanwhile
  Frame wait(int index);

  /// Indices of the cached frames, ascending.
  std::vector<int> cached() const;
  /// Number of frames computed.
  long long computed() const;

 private:
  void run();
  /// The frame to compute next; -1: none.
  int nextIndex() const;
  /// Distance of a frame from the next expected one; the frame with the largest distance is dropped first.
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
  mutable std::exception_ptr failure_;  // not rethrown yet

  std::thread thread_;
};

}  // namespace emscape::playback
