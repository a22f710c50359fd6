/// Positions between samples by polynomials.
#pragma once

#include <string>
#include <vector>

#include "emscape/base/vec.h"
#include "recording/common/track_recorder.h"

namespace emscape::interop {

struct EcefSample {
  double t_s = 0;
  Vec3d position_m;
};

/// Adds samples of an object, and between them as many positions of the interpolating polynomial as straight
/// lines need to be within a metre of it, at most 64.
/// @param samples  t_s strictly increasing
/// @param degree  of Lagrange's polynomial through the samples around each interval; 1: straight lines
void addInterpolated(TrackRecorder& recorder, std::size_t object, const std::vector<EcefSample>& samples,
                     int degree, const std::string& location);

}  // namespace emscape::interop
