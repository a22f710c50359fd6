/// A voxel's excess loss, for storage between updates: a 16-bit code, or for surfaces a float.
///
/// Excess is the loss of a path minus its free-space loss; negative where rays add constructively. It depends
/// on the emitter's position, frequency and polarisation, the terrain and the atmosphere, not on power or
/// antenna, except for models that use the antenna's elevation cut.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

using ExcessCode = std::int16_t;

constexpr float kExcessCodesPerDb = 128;
/// Largest magnitude of the excess in a code (dB); larger values saturate.
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
/// The same for an excess in dB; 0 for NaN (unknown).
EMSCAPE_HD inline float excessFactor(float excess_db) {
  const float factor = fastDbToRatio(-excess_db);
  return excess_db == excess_db ? factor : 0.0f;
}

/// Excess of voxels, dense order: one of the two representations, or none.
struct ExcessView {
  const ExcessCode* codes = nullptr;
  const float* db = nullptr;

  EMSCAPE_HD bool isEmpty() const { return codes == nullptr && db == nullptr; }
  EMSCAPE_HD float factor(std::size_t voxel) const {
    return db != nullptr ? excessFactor(db[voxel]) : excessFactor(codes[voxel]);
  }
};

/// The same while it is filled.
struct ExcessStore {
  ExcessCode* codes = nullptr;
  float* db = nullptr;

  /// NaN: unknown.
  EMSCAPE_HD float get(std::size_t voxel) const {
    if (db != nullptr) return db[voxel];
    return codes[voxel] == kUnknownExcess ? NAN : excessDb(codes[voxel]);
  }
  /// @param excess_db  NaN: unknown
  EMSCAPE_HD void set(std::size_t voxel, float excess_db) const {
    if (db != nullptr) {
      db[voxel] = excess_db;
    } else {
      codes[voxel] = excessCode(excess_db);
    }
  }
};

}  // namespace emscape::emfield
