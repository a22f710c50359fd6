/// Directions between objects and in their axes.
#pragma once

#include "recording/common/recording.h"
#include "recording/dis/orientation.h"

namespace emscape::interop {

/// Relative to the axes of an object (deg): azimuth clockwise from ahead, elevation upwards.
struct RelativeDirection {
  double azimuth_deg = 0, elevation_deg = 0;
};

/// Axes of an object; one that tells no heading points along its track.
dis::BodyAxes axesAt(const RecordedObject& object, double t_s);

/// Position (m) on the earth, to compare near objects: heights above the sea stand for those above the
/// ellipsoid, since the geoid below them is nearly the same.
Vec3d spotOf(const PoseSample& pose);

/// Direction of an object from another, in the axes of the latter.
RelativeDirection directionAt(const RecordedObject& from, const RecordedObject& to, double t_s);

/// A direction in the axes of one body in those of another.
RelativeDirection turned(const RelativeDirection& direction, const dis::BodyAxes& from,
                         const dis::BodyAxes& to);

/// Axes of a level body that points north.
dis::BodyAxes northAt(const PoseSample& pose);

/// Brings directions from true north and the horizon into the axes of the beams' carriers: also at the times
/// at which these turn, at most 5000 of a beam.
/// @param is_from_north  of each beam
/// @throws Error (bad_input) if a recording may not have so many states
void turnIntoCarriers(Recording& recording, const std::vector<bool>& is_from_north);

}  // namespace emscape::interop
