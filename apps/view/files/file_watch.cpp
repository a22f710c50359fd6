#include "apps/view/files/file_watch.h"

#include <sys/stat.h>

#include <chrono>
#include <utility>

namespace emscape::view {

FileWatch::FileWatch(std::function<void()> wake, double interval_s)
    : wake_(std::move(wake)), interval_s_(interval_s) {
  worker_.push([this] { run(); });
}

FileWatch::~FileWatch() {
  stops_ = true;
  stopped_.set();
}

FileWatch::Stamp FileWatch::stampOf(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return {};
  return {std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec, status.st_size,
          status.st_ino};
}

void FileWatch::watch(const std::vector<std::string>& files) {
  std::map<std::string, Watched> next;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const std::string& file : files) {
    const auto known = files_.find(file);
    const Stamp stamp = known == files_.end() ? stampOf(file) : Stamp{};
    next.emplace(file, known == files_.end() ? Watched{stamp, stamp} : known->second);
  }
  files_ = std::move(next);
}

std::vector<std::string> FileWatch::takeChanged() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::set<std::string> changed = std::exchange(changed_, {});
  return {changed.begin(), changed.end()};
}

/// @return true if there is a change to report
bool FileWatch::look(const std::vector<std::string>& files) {
  std::map<std::string, Stamp> stamps;  // the files are queried without the lock
  for (const std::string& file : files) stamps[file] = stampOf(file);
  const std::lock_guard<std::mutex> lock(mutex_);
  bool has_changed = false;
  for (const auto& [file, stamp] : stamps) {
    const auto watched = files_.find(file);
    if (watched == files_.end()) continue;
    auto& [known, seen] = watched->second;
    const bool is_whole = std::exchange(seen, stamp) == stamp && stamp.bytes >= 0;
    if (!is_whole || stamp == known) continue;
    known = stamp;
    changed_.insert(file);
    has_changed = true;
  }
  return has_changed;
}

void FileWatch::run() {
  using Clock = std::chrono::steady_clock;
  const auto interval =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_s_));
  for (;;) {
    stopped_.waitUntil(Clock::now() + interval);
    if (stops_) return;
    std::vector<std::string> files;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      for (const auto& [file, watched] : files_) files.push_back(file);
    }
    if (look(files)) wake_();
  }
}

}  // namespace emscape::view
