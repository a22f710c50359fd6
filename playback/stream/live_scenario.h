/// The scenario of a live battlefield, and poses for it.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "emscape/playback/frames/inputs.h"
#include "interop/live/live_state.h"
#include "playback/stream/live_battlefield.h"
#include "playback/stream/named_poses.h"

namespace emscape::playback {

/// A scenario that was made of the objects of a stream. Immutable.
struct LiveScenario {
  struct Object {
    std::size_t pose = 0;  ///< index into `poses`
    double raise_m = 0;    ///< of the platform above the object
  };

  LoadedScenario loaded;
  std::vector<NamedPose> poses;  ///< of the platforms that the stream moves, when the scenario was made
  std::unordered_map<std::uint64_t, Object> objects;  ///< by their keys
  int emitters = 0, unmatched = 0;
  std::vector<std::string> silent, untold;  ///< platforms of the base (StreamStatus)
};

/// File of the field that `emscape live` computes, beside the scenario's.
constexpr const char* kLiveField = "live.vdb";

/// Makes scenarios from a base, in a file of a folder of its own.
class LiveScenarioMaker {
 public:
  /// @throws Error (bad_input): faults of the base or the database
  explicit LiveScenarioMaker(const StreamRequest& request);
  ~LiveScenarioMaker();
  LiveScenarioMaker(const LiveScenarioMaker&) = delete;
  LiveScenarioMaker& operator=(const LiveScenarioMaker&) = delete;

  const std::string& file() const { return file_; }
  /// Writes the base into the file, and removes a field that is to be replaced: when the stream can be
  /// received. @throws Error
  void writeBase() const;
  /// The base alone.
  std::shared_ptr<const LiveScenario> base() const;
  /// @param before  the last poses: platforms of the base that the recording lacks stay there, absent
  /// @throws Error
  std::shared_ptr<const LiveScenario> make(interop::LiveRecording recording,
                                           const std::vector<NamedPose>& before);

 private:
  void keepBase(LiveScenario& made, const std::vector<NamedPose>& before) const;

  const StreamRequest request_;
  std::string folder_, file_;
  LoadedScenario base_, last_;
};

/// Moves the poses of a scenario's platforms to where their objects are now. Positions below the ground are
/// raised above it. A platform whose object is not there, or has a pose out of its range, stays.
/// @param poses  in the order of LiveScenario::poses
void movePoses(const LiveScenario& scenario, const std::vector<interop::LivePose>& live,
               std::vector<NamedPose>& poses);

}  // namespace emscape::playback
