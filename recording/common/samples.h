/// Adding samples to a recording, and limits of its size.
#pragma once

#include <cstddef>
#include <vector>

#include "recording/common/recording.h"

namespace emscape::interop {

/// Largest numbers in a recording: what a hostile file can make the program allocate.
struct RecordingLimits {
  static constexpr std::size_t kObjects = 100000;
  static constexpr std::size_t kSamples = 20000000;  ///< poses and states of beams
  static constexpr std::size_t kKinds = 200;         ///< of what is ignored
};

/// Adds a pose. Of an object that rests only the first and the last pose are kept; a pose of the same time
/// replaces the last one.
void addPose(std::vector<PoseSample>& poses, const PoseSample& pose);

/// Adds a state unless it is equal to the last one.
void addState(std::vector<BeamState>& states, const BeamState& state);

/// Adds a change of presence.
void addPresence(std::vector<PresenceSample>& presence, double t_s, bool is_present);

/// Puts the samples of an object in the order of time; of several poses at one time the last one added is
/// kept.
void sortByTime(RecordedObject& object);
void sortByTime(RecordedBeam& beam);

/// Removes objects, with their beams; beams that are held on one of them are held on nothing.
/// @param is_kept  of each object
void keepObjects(Recording& recording, const std::vector<bool>& is_kept);

}  // namespace emscape::interop
