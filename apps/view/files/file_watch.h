/// Detects files that have changed on the disk.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "base/event.h"
#include "base/worker.h"

namespace emscape::view {

/// Polls files every two seconds, on a separate thread: the disk may be slow, or on another machine without
/// change events. The object belongs to one thread.
class FileWatch {
 public:
  static constexpr double kInterval_s = 2;

  /// @param wake  called on the thread of this object when there is a change
  explicit FileWatch(std::function<void()> wake, double interval_s = kInterval_s);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Sets the files to watch. Changes are reported from now on; for files already watched, since they were
  /// first watched. Folders change when files are added or removed.
  void watch(const std::vector<std::string>& files);
  /// Files that were written or replaced since the last report, in order. A file that is still changing, or
  /// that is missing, is not reported.
  std::vector<std::string> takeChanged();

 private:
  /// Time stamp and size of a file.
  struct Stamp {
    std::int64_t written_ns = 0, bytes = -1;  ///< bytes -1: there is no such file
    std::uint64_t inode = 0;
    bool operator==(const Stamp& other) const {
      return written_ns == other.written_ns && bytes == other.bytes && inode == other.inode;
    }
  };
  struct Watched {
    Stamp known, seen;  ///< at the last report or, before one, at the first poll; at the last poll
  };
  static Stamp stampOf(const std::string& file);
  void run();
  bool look(const std::vector<std::string>& files);

  const std::function<void()> wake_;
  const double interval_s_;
  std::mutex mutex_;
  std::map<std::string, Watched> files_;
  std::set<std::string> changed_;
  std::atomic<bool> stops_{false};
  Event stopped_;
  Worker worker_;
};

}  // namespace emscape::view
