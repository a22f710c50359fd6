/// Times of tracks.
#pragma once

namespace emscape::scenario {

/// Times (s) so near to an end of a track are within it: recordings have ticks, those of DIS of 1.7e-6 s.
constexpr double kTrackRounding_s = 5e-6;

}  // namespace emscape::scenario
