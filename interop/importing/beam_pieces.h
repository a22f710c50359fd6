/// A beam over time as emitters of a scenario, whose frequency, power and scan do not change.
#pragma once

#include <vector>

#include "recording/common/recording.h"

namespace emscape::interop {

/// The times within a window at which an object is present and has a position, without their ends.
std::vector<TimeSpan> presenceOf(const RecordedObject& object, TimeSpan window);

/// Direction of a beam from begin_s to end_s.
struct Pointing {
  double begin_s = 0, end_s = 0;
  double azimuth_deg = 0, elevation_deg = 0;
};

/// The times at which a beam is on with the same settings.
struct BeamPiece {
  BeamState state;  ///< settings; the direction is that of the first pointing
  std::vector<TimeSpan> active;
  std::vector<Pointing> pointings;  ///< in the order of time, equal neighbours joined; empty if not told
};

/// Settings are equal within 0.1 % of the frequency, 0.25 dB, 1 % of the pulses' figures and half a degree of
/// the sweeps. Of more than kMaxPieces different settings the later ones are left out.
/// @param cut  set to true if that happened
constexpr std::size_t kMaxPieces = 32;
std::vector<BeamPiece> piecesOf(const RecordedBeam& beam, const std::vector<TimeSpan>& presence, bool& cut);

/// Pointings with neighbours joined that differ by less than a tolerance, which grows from 0.1 degree until
/// there are at most `count`.
std::vector<Pointing> reduced(const std::vector<Pointing>& pointings, std::size_t count);

}  // namespace emscape::interop
