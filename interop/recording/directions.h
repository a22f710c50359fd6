/// Directions between objects and in their axes.
#pragma once

#include "interop/dis/orientation.h"
#include "interop/recording/recording.h"

namespace emscape::interop {

/// Relative to the axes of an object (deg): azimuth clockwise from ahead, elevation upwards.
struct RelativeDirection {
  double azimuth_deg = 0, elevation_deg = 0;
};

/// Axes of an object; one that tells no heading points along its track.
dis::BodyAxes axesAt(const RecordedObject& object, double t_s);

/// Direction of an object from another, in the axes of the latter.
RelativeDirection directionAt(const RecordedObject& from, const RecordedObject& to, double t_s);

/// A direction in the axes of one body in those of another.
RelativeDirection turned(const RelativeDirection& direction, const dis::BodyAxes& from,
                         const dis::BodyAxes& to);

/// Axes of a level body that points north.
dis::BodyAxes northAt(const PoseSample& pose);

/// States whose directions are from true north and the horizon, in the axes of their carrier: also at the
/// times at which it turns.
std::vector<BeamState> inAxesOf(const RecordedObject& carrier, const std::vector<BeamState>& states);

}  // namespace emscape::interop
