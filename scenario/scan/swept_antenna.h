/// The pattern of an antenna over an interval in which its beam moves.
#pragma once

#include "emscape/scenario/antenna/antenna.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {

/// Largest number of even intervals of an interval's table in azimuth, half of it in elevation: for narrower
/// beams, tables are refined around the beam's directions.
constexpr int kMaxSweptAzimuths = 2880;

enum class SweptPattern {
  largest,  ///< the largest amplitude of the interval
  mean      ///< the root of the mean power of the interval
};

/// The pattern in the frame about whose up axis the beam turns (arcs), or in the frame of the array (dwells);
/// forward is azimuth 0 of the sweep. It has the antenna's gain: amplitudes are relative to the beam's
/// maximum, and a mean includes the active part of the interval.
/// @param sweep  not empty; azimuths of arcs relative to the frame
/// @accuracy 0.1 dB down to 20 dB below the maximum, without nulls to 30 dB; next to nulls 0.5 dB. Entries of
/// tables are a 16th of a beamwidth apart (up to an 8th for beams of 1 to 2 degrees; for whole turns, which
/// depend only on elevation, a 32nd), for beams narrower than 1 degree a 20th to 12 beamwidths from the
/// beam's directions, less where a scan has very many; beyond them 1/8 degree
AntennaPtr sweptAntenna(const Antenna& antenna, const ScanSweep& sweep, SweptPattern pattern);

/// True for scans whose pattern is computed by whole rows (many_arcs.h), not arc by arc, which takes longer;
/// of beams whose table is not refined.
/// @param tilts  different elevations of the arcs
inline bool areManyArcs(std::size_t arcs, std::size_t tilts, SweptPattern pattern) {
  constexpr std::size_t kFew = 128, kFewOfMean = 12;
  return arcs > kFew || (pattern == SweptPattern::mean && arcs > kFewOfMean * tilts);
}

/// Entries of the table of an interval's pattern, and azimuths from which each of its rows is computed.
struct SweptSize {
  double azimuths = 0, elevations = 0, azimuths_of_row = 0;
};
SweptSize sweptSizeOf(const Antenna& antenna, const ScanSweep& sweep);

/// How low (dB) a Gaussian beam's value may be on its axis, between two entries of its table: 0.05 dB and
/// less, more where a scan has so many directions that its table cannot be fine around all of them.
double lowOnAxis_db(const Antenna& antenna, const ScanSweep& sweep);

}  // namespace emscape::scenario
