/// The scenario of a live battlefield, and poses for it.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/frames/inputs.h"
#include "interop/live/live_state.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::playback {

/// A scenario that was made of the objects of a stream. Immutable.
struct LiveScenario {
  struct Platform {
    int index = -1;      ///< in the scenario
    double raise_m = 0;  ///< above the object
  };

  LoadedScenario loaded;
  std::unordered_map<std::uint64_t, Platform> platforms;  ///< by the key of their object
  int emitters = 0, unmatched = 0;
};

/// Makes scenarios from a base, in a file of a folder of its own.
class LiveScenarioMaker {
 public:
  /// @throws Error (bad_input): faults of the base or the database
  explicit LiveScenarioMaker(const StreamRequest& request);
  ~LiveScenarioMaker();
  LiveScenarioMaker(const LiveScenarioMaker&) = delete;
  LiveScenarioMaker& operator=(const LiveScenarioMaker&) = delete;

  const std::string& file() const { return file_; }
  /// The base alone.
  std::shared_ptr<const LiveScenario> base() const;
  /// @throws Error
  std::shared_ptr<const LiveScenario> make(interop::LiveRecording recording);

 private:
  const StreamRequest request_;
  std::string folder_, file_;
  LoadedScenario base_, last_;
};

/// The poses of the platforms; positions below the ground are raised above it.
std::vector<scenario::PlatformPose> platformPoses(const LiveScenario& scenario,
                                                  const std::vector<interop::LivePose>& poses);

}  // namespace emscape::playback
