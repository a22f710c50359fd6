/// Equivalent heights (km): uniform air with the surface's state and this height attenuates like the whole
/// atmosphere.
#pragma once

#include "propagation/air/gases.h"

namespace emscape::propagation {

/// @param frequency_ghz  1..350
/// @see P.676-13 Annex 2 eq. (31)
double oxygenEquivalentHeight_km(double frequency_ghz, const AirState& surface);

/// @see P.676-13 Annex 2 eq. (37) and table 4
double vapourEquivalentHeight_km(double frequency_ghz);

}  // namespace emscape::propagation
