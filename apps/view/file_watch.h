/// Tells which files have changed on the disk.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace emscape::view {

/// Looks at files every two seconds, on a thread of its own: they may lie on a disk that sleeps, or on
/// another machine, whose changes no event tells. The object belongs to one thread.
class FileWatch {
 public:
  static constexpr double kInterval_s = 2;

  /// @param wake  called on the thread of this object when there is a change
  explicit FileWatch(std::function<void()> wake, double interval_s = kInterval_s);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Looks at these files, and no others any more. Changes from now on count; of those that are looked at
  /// already, those since they were. Folders change when files come or go.
  void watch(const std::vector<std::string>& files);
  /// Files that were written or replaced since they were told last, in their order. A file that still changes
  /// from look to look, or that is gone, is not told.
  std::vector<std::string> takeChanged();

 private:
  /// What tells a file from what it was before.
  struct Stamp {
    std::int64_t written_ns = 0, bytes = -1;  ///< bytes -1: there is no such file
    std::uint64_t inode = 0;
    bool operator==(const Stamp& other) const {
      return written_ns == other.written_ns && bytes == other.bytes && inode == other.inode;
    }
  };
  struct Watched {
    Stamp known, seen;  ///< told or first; at the last look
  };
  static Stamp stampOf(const std::string& file);
  void run();
  bool look(const std::vector<std::string>& files);

  const std::function<void()> wake_;
  const double interval_s_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stops_ = false;
  std::map<std::string, Watched> files_;
  std::set<std::string> changed_;
  std::thread thread_;
};

}  // namespace emscape::view
