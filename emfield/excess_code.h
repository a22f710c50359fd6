/// The excess loss of a voxel as it is kept between updates: 16 bits.
///
/// Excess is a path's loss less that of free space; negative where paths add up. It depends on the emitter's
/// place, frequency and polarisation and on terrain and air, neither on its power nor on where its antenna
/// looks.
#pragma once

#include <cstdint>

#include "base/fast_math.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

using ExcessCode = std::int16_t;

constexpr float kExcessCodesPerDb = 128;
/// Largest excess that a code holds (dB), either way; beyond it saturates.
constexpr float kLargestExcess_db = 32767 / kExcessCodesPerDb;
/// Stands for a path of which nothing is known.
constexpr ExcessCode kUnknownExcess = -32768;

/// @accuracy half a step: 1/256 dB
/// @param excess_db  NaN: unknown
EMSCAPE_HD inline ExcessCode excessCode(float excess_db) {
  if (!(excess_db == excess_db)) return kUnknownExcess;
  if (excess_db >= kLargestExcess_db) return 32767;
  if (excess_db <= -kLargestExcess_db) return -32767;
  const float steps = excess_db * kExcessCodesPerDb;
  return static_cast<ExcessCode>(steps < 0 ? steps - 0.5f : steps + 0.5f);
}

/// The excess (dB) that a code stands for; the unknown code must be handled before.
EMSCAPE_HD inline float excessDb(ExcessCode code) {
  return static_cast<float>(code) / kExcessCodesPerDb;
}

/// What a code multiplies power density by; 0 for the unknown.
EMSCAPE_HD inline float excessFactor(ExcessCode code) {
  const float factor = fastDbToRatio(static_cast<float>(code) * (-1 / kExcessCodesPerDb));
  return code == kUnknownExcess ? 0.0f : factor;
}

}  // namespace emscape::emfield
