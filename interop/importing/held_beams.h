/// Beams that are held on a target.
#pragma once

#include "recording/common/recording.h"

namespace emscape::interop {

/// The states of a beam with those that are held on a target replaced by their directions, one a second or,
/// over long times, 2000 in all. Such a state has no sweep.
std::vector<BeamState> withDirections(const RecordedBeam& beam, const std::vector<RecordedObject>& objects);

}  // namespace emscape::interop
