/// What a stream of another program tells of a battlefield now.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "recording/common/recording.h"

namespace emscape::interop {

/// Largest numbers of a live battlefield: what a hostile stream can make the program keep.
struct LiveLimits {
  static constexpr std::size_t kObjects = 4096;  ///< of more the ones heard of longest ago are forgotten
  static constexpr std::size_t kBeams = 8192;    ///< further ones of DIS are not taken
};

struct LiveCounts {
  long long records = 0;     ///< PDUs or lines
  long long bad = 0;         ///< could not be read
  long long late = 0;        ///< came after a later state of their entity
  long long duplicates = 0;  ///< came twice
  long long outside = 0;     ///< positions that are too high or too low, which are not used
  long long forgotten = 0;   ///< objects and beams beyond LiveLimits
  std::string first_bad;     ///< reason of the first that could not be read
};

struct LivePose {
  std::uint64_t key = 0;  ///< of the object
  PoseSample pose;
};

/// With angles in the range of a scenario's: streams may count on. Unknown angles stay unknown.
inline PoseSample withAnglesInRange(PoseSample pose) {
  pose.heading_deg = std::remainder(pose.heading_deg, 360);
  pose.pitch_deg = std::clamp(pose.pitch_deg, -90.0, 90.0);
  pose.roll_deg = std::remainder(pose.roll_deg, 360);
  return pose;
}

/// The objects now, each with one pose, and their beams, each with one state, at t = 0.
struct LiveRecording {
  Recording recording;
  std::vector<std::uint64_t> keys;  ///< of Recording::objects
};

/// Takes the bytes of a stream. Memory is bounded whatever they are; none of them is an error. For one thread
/// at a time.
class LiveState {
 public:
  LiveState() = default;
  virtual ~LiveState() = default;
  LiveState(const LiveState&) = delete;
  LiveState& operator=(const LiveState&) = delete;

  /// @param arrival_s  never decreasing
  virtual void take(const std::uint8_t* bytes, std::size_t size, double arrival_s) = 0;
  /// Forgets what has not been heard of for too long. To be called before the state is asked.
  virtual void expire(double now_s) = 0;

  /// Changes when recording() would have other objects or beams, or other settings of them; poses apart.
  long long revision() const { return revision_; }
  /// The present battlefield.
  virtual LiveRecording recording(double now_s) = 0;
  /// Poses of the objects now, by dead reckoning where the stream states how. All values are finite and
  /// within the limits of a scenario.
  virtual std::vector<LivePose> poses(double now_s) const = 0;
  virtual std::size_t objectCount() const = 0;

  const LiveCounts& counts() const { return counts_; }

 protected:
  void countBad(const std::string& reason) {
    if (counts_.bad++ == 0) counts_.first_bad = reason;
  }

  LiveCounts counts_;
  long long revision_ = 0;
};

}  // namespace emscape::interop
