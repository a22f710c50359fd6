/// Long work that other threads follow, and may abandon.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <string>

#include "emscape/base/progress.h"

namespace emscape {

/// Thrown by work that was abandoned. Finished steps are kept.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// @param stop  may be null
/// @throws Stopped
inline void throwIfStopped(const StopFlag* stop) {
  if (stop != nullptr && *stop) throw Stopped();
}

/// Progress of a piece of work.
struct WorkProgress {
  std::string what;      ///< "power_density_dbwm2 at 49.5 s"
  std::string part;      ///< "'search radar' by parabolic equation, 1 of 4"; may be empty
  double fraction = -1;  ///< completed, 0..1; negative: unknown
};

/// Work of one thread and its loops (parallelFor). Models pass a checkpoint() at least every few
/// milliseconds.
class Work {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param stop  also stops the work when it is set; may be null, else outlives this
  explicit Work(const StopFlag* stop = nullptr) : flag_(stop) {}
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Begins another piece of work, which is not stopped.
  void begin(const std::string& what);

  // Any thread calls the following.
  void stop() { stopAt(Time::min()); }
  /// Stops the work at a time, unless it is stopped earlier.
  void stopAt(Time time);
  bool isStopped() const;
  WorkProgress progress() const;

 private:
  friend class WorkPart;
  friend void reportDone(double fraction);

  const StopFlag* const flag_;
  std::atomic<Time::rep> stop_at_{Time::max().time_since_epoch().count()};
  std::atomic<double> begin_{0}, end_{1}, done_{-1};  // of the part, in the whole; done_: of the whole
  mutable std::mutex mutex_;
  std::string what_, part_;
};

/// While it exists, the calling thread works on a piece of work; its loops do, too.
class WorkScope {
 public:
  explicit WorkScope(Work* work);
  ~WorkScope();
  WorkScope(const WorkScope&) = delete;
  WorkScope& operator=(const WorkScope&) = delete;

 private:
  Work* const before_;
};

/// The work of the calling thread; null: none.
Work* currentWork();

/// @throws Stopped if the calling thread's work is stopped
void checkpoint();

/// A part of the calling thread's work, which reports its progress. Parts may be nested.
class WorkPart {
 public:
  /// @param name  empty: that of the part around it
  /// @param from, to  of the part around it, 0..1
  WorkPart(const std::string& name, double from, double to);
  ~WorkPart();
  WorkPart(const WorkPart&) = delete;
  WorkPart& operator=(const WorkPart&) = delete;

 private:
  Work* const work_;
  double begin_ = 0, end_ = 1;  // of the part around it
  std::string name_;
};

/// Reports the completed fraction (0..1) of the present part; also from its loops. Smaller fractions than
/// reported before have no effect.
void reportDone(double fraction);

}  // namespace emscape
