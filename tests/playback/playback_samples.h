/// Scenarios, sources and clocks for the tests of this module.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "base/event.h"
#include "emscape/playback/frames/frame_source.h"
#include "playback/pictures/clock.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::playback::test {

using emscape::test::errorOf;
using emscape::test::readFile;
using emscape::test::TemporaryFolder;
using emscape::test::writeFile;

/// scenarios/quick.yaml with each text `from` replaced by `to`, in a folder of the test. @return the file
inline std::string quickScenario(const TemporaryFolder& folder,
                                 const std::vector<std::pair<std::string, std::string>>& replaced = {}) {
  std::string text = readFile(emscape::test::shippedScenario("quick.yaml"));
  for (const auto& [from, to] : replaced) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("quick.yaml does not hold " + from);
    text.replace(at, from.size(), to);
  }
  return folder.write("scenario.yaml", text);
}

/// Made-up frames: one volume of 8 x 8 x 8 voxels each; the first has the value of the index and a half.
class MadeFrames : public FrameSource {
 public:
  static constexpr int kVoxels = 8 * 8 * 8;

  /// @param before  called at the beginning of frame(), on its thread
  explicit MadeFrames(std::vector<double> times_s, std::function<void(int)> before = {})
      : times_s_(std::move(times_s)), before_(std::move(before)) {}

  int count() const override { return static_cast<int>(times_s_.size()); }
  double time_s(int index) const override { return times_s_[static_cast<std::size_t>(index)]; }
  Frame makeFrame(int index) override {
    if (before_) before_(index);
    {
      std::lock_guard<std::mutex> lock(mutex_);
      asked_.push_back(index);
    }
    volume::DenseVolume volume;
    volume.grid.dims = {8, 8, 8};
    volume.grid.spacing_m = {100, 100, 100};
    volume.info.quantity = "made";
    volume.info.time_s = time_s(index);
    volume.info.floor = -1;
    volume.info.range_min = 0;
    volume.info.range_max = static_cast<float>(count());
    const auto greatest = static_cast<float>(count());
    for (int voxel = 0; voxel < kVoxels; ++voxel) {
      volume.values.push_back(
          std::fmod(static_cast<float>(index) + 0.5F + 0.37F * static_cast<float>(voxel), greatest));
    }
    Frame frame{{volume::Volume(std::move(volume)), nullptr}, {}, {}, changes, true, {}};
    const bool is_part = is_slow && goal_ms_ > 0;
    frame.changed = changes || (is_incomplete_ && !is_part);
    is_incomplete_ = is_part && (changes || is_incomplete_ || index == 1);
    frame.column_step = is_incomplete_ ? 2 : 1;
    return frame;
  }
  void setTimeGoal(double goal_ms) override { goal_ms_ = goal_ms; }
  std::string name() const override { return "made"; }
  const LoadedScenario* scene() const override { return nullptr; }
  std::vector<std::string> warnings() const override { return {}; }

  /// Indices that frame() was called with, in order.
  std::vector<int> asked() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return asked_;
  }
  bool changes = true;
  bool is_slow =
      false;  ///< with a time goal every second column is interpolated; without changes from step 1 on

 private:
  double goal_ms_ = 0;
  bool is_incomplete_ = false;
  const std::vector<double> times_s_;
  const std::function<void(int)> before_;
  mutable std::mutex mutex_;
  std::vector<int> asked_;
};

inline std::vector<double> seconds(int count) {
  std::vector<double> times_s;
  for (int i = 0; i < count; ++i) times_s.push_back(i);
  return times_s;
}

/// Time that passes only while the loop waits. Work of other threads takes no time, or does not end before
/// the loop needs its result.
class ManualClock : public Clock {
 public:
  explicit ManualClock(bool work_takes_no_time = true) : work_takes_no_time_(work_takes_no_time) {}

  double now_ms() const override { return now_ms_; }
  void waitUntil(double time_ms, Event& event) override {
    if (work_takes_no_time_ && event.hasWork()) {
      event.wait();
      return;
    }
    now_ms_ = std::max(now_ms_.load(), time_ms);
  }

 private:
  const bool work_takes_no_time_;
  std::atomic<double> now_ms_{0};
};

}  // namespace emscape::playback::test
