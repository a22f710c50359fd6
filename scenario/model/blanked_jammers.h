/// Limit of the model of side-lobe blanking.
#pragma once

namespace emscape::scenario {

/// Jammers of pulses whose overlaps are computed at a radar with side-lobe blanking.
constexpr int kMaxBlankedJammers = 4;

}  // namespace emscape::scenario
