/// 16-bit code of a voxel's excess loss, for storage between updates.
///
/// Excess is a path's loss less that of free space; negative where rays add up. It depends on the emitter's
/// position, frequency and polarisation and on terrain and air, not on its power or antenna.
#pragma once

#include <cstdint>

#include "base/fast_math.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

using ExcessCode = std::int16_t;

constexpr float kExcessCodesPerDb = 128;
/// Largest excess that a code holds (dB), either way; beyond it saturates.
constexpr float kMaxExcess_db = 32767 / kExcessCodesPerDb;
/// Code of an unknown path.
constexpr ExcessCode kUnknownExcess = -32768;

/// @accuracy half a step: 1/256 dB
/// @param excess_db  NaN: unknown
EMSCAPE_HD inline ExcessCode excessCode(float excess_db) {
  if (!(excess_db == excess_db)) return kUnknownExcess;
  if (excess_db >= kMaxExcess_db) return 32767;
  if (excess_db <= -kMaxExcess_db) return -32767;
  const float steps = excess_db * kExcessCodesPerDb;
  return static_cast<ExcessCode>(steps < 0 ? steps - 0.5f : steps + 0.5f);
}

/// The excess (dB) of a code; not for the unknown code.
EMSCAPE_HD inline float excessDb(ExcessCode code) {
  return static_cast<float>(code) / kExcessCodesPerDb;
}

/// Factor (power ratio) of a code on the power density; 0 for the unknown code.
EMSCAPE_HD inline float excessFactor(ExcessCode code) {
  const float factor = fastDbToRatio(static_cast<float>(code) * (-1 / kExcessCodesPerDb));
  return code == kUnknownExcess ? 0.0f : factor;
}

}  // namespace emscape::emfield
