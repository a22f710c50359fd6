/// Warnings that the libraries log while an input is open.
#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace emscape::view {

/// Any thread may use it.
class MessageLog {
 public:
  /// Keeps a line unless it is known already.
  void add(const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) lines_.push_back(line);
  }
  void remove(const std::vector<std::string>& lines) {
    const std::lock_guard<std::mutex> lock(mutex_);
    lines_.erase(std::remove_if(lines_.begin(), lines_.end(),
                                [&lines](const std::string& line) {
                                  return std::find(lines.begin(), lines.end(), line) != lines.end();
                                }),
                 lines_.end());
  }
  /// Replaces all lines. @return those before
  std::vector<std::string> exchange(std::vector<std::string> lines) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(lines_, std::move(lines));
  }
  std::vector<std::string> lines() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lines_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace emscape::view
