/// Beams that are held on a target.
#pragma once

#include "emscape/interop/recording.h"

namespace emscape::interop {

/// Direction of an object from another, relative to the axes of the latter (deg): azimuth clockwise from
/// ahead, elevation upwards.
struct RelativeDirection {
  double azimuth_deg = 0, elevation_deg = 0;
};
RelativeDirection directionAt(const RecordedObject& from, const RecordedObject& to, double t_s);

/// The states of a beam with those that are held on a target replaced by their directions, one a second or,
/// over long times, 2000 in all. Such a state has no sweep.
std::vector<BeamState> withDirections(const RecordedBeam& beam, const std::vector<RecordedObject>& objects);

}  // namespace emscape::interop
