/// Objects of an ACMI recording that stand for the beams of others.
#pragma once

#include <string>
#include <unordered_map>

#include "recording/common/recording.h"

namespace emscape::interop {

/// Makes the objects of type Beam beams of the objects that carry them: their Parent, or without one the
/// nearest object within 50 m of the beam's first position. The beam is on while its object is present; its
/// direction is that of the object's attitude with its RadarAzimuth and RadarElevation. A beam whose carrier
/// is not found stays an object.
/// @param recording  with samples in the order of time
/// @param parents  of objects, by index: the ids of their parents
void joinCarriedBeams(Recording& recording, const std::unordered_map<std::size_t, std::string>& parents);

}  // namespace emscape::interop
