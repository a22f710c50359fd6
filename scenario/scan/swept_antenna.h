/// The pattern of an antenna over an interval in which its beam moves.
#pragma once

#include "emscape/scenario/antenna/antenna.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {

/// Largest number of intervals of an interval's table in azimuth, half of it in elevation: narrow beams are
/// sampled no more finely.
constexpr int kMaxSweptAzimuths = 2880;

enum class SweptPattern {
  largest,  ///< the largest amplitude of the interval
  mean      ///< the root of the mean power of the interval
};

/// The pattern in the frame about whose up axis the beam turns (arcs), or in the frame of the array (dwells);
/// forward is azimuth 0 of the sweep. It has the antenna's gain: amplitudes are relative to the beam's
/// maximum, and a mean includes the active part of the interval.
/// @param sweep  not empty; azimuths of arcs relative to the frame
/// @accuracy 0.1 dB down to 20 dB below the maximum, without nulls to 30 dB; next to nulls 0.5 dB; for
/// beamwidths below 1.5 degrees 0.2 dB. Entries of tables are a 16th of a beamwidth apart, but at least 1/8
/// degree; entries for whole turns, which depend only on elevation, a 32nd or 1/40 degree
AntennaPtr sweptAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern);

}  // namespace emscape::scenario
