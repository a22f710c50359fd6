/// Dead reckoning of DIS, algorithms 1 to 9.
#pragma once

#include "recording/dis/orientation.h"
#include "recording/dis/pdu.h"

namespace emscape::interop::dis {

struct ReckonedPose {
  Vec3d position_m;  ///< ECEF
  BodyAxes axes;
};

/// Position and orientation of an entity some time after its state was sent.
///
/// World axes: P0 + V t (2, 3), with A t^2 / 2 (4, 5). Body axes: velocity V (6, 7) or V + A t (8, 9) in axes
/// that turn with the angular velocity. The orientation turns with 3, 4, 7 and 8. Algorithm 1 and unknown
/// ones: at rest.
/// @param t_s  any sign
/// @see IEEE 1278.1, annex on dead reckoning
ReckonedPose reckonedPose(const EntityState& state, double t_s);

}  // namespace emscape::interop::dis
