/// A scalar field on a grid, in memory.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/unset_vector.h"
#include "emscape/volume/grid.h"

namespace emscape::volume {

/// Floor of fields in which every finite value, including 0, is a field: arrays of other programs, which have
/// no floor.
constexpr float kNoFloor = std::numeric_limits<float>::lowest();

/// Limit of the times of volumes, before and after the epoch (s). Other programs may count from another one.
constexpr double kMaxTime_s = 1e12;

/// Description of the values. Every volume file contains it, as `emscape:*` if the format has metadata.
struct VolumeInfo {
  std::string
      quantity;       ///< name with its unit as suffix, for example power_density_dbwm2; names the .vdb grid
  std::string unit;   ///< for a colour bar, for example dBW/m2; empty for counts
  double time_s = 0;  ///< since the scenario's epoch
  std::string time_utc;  ///< ISO 8601, empty if there is no epoch
  float floor = 0;       ///< value of voxels that hold no field; the background of sparse grids
  float range_min = 0;   ///< value range of the whole series, floor and masked voxels left out
  float range_max = 0;
  bool categorical = false;  ///< indices (dominant_emitter): nearest sampling, int grid in .vdb
  std::map<std::string, std::string> extra;  ///< further metadata by key: scenario hash, version, warnings
  /// False if the file that was read does not state its time; time_s is then 0. Not compared by ==.
  bool has_time = true;
};

bool operator==(const VolumeInfo& a, const VolumeInfo& b);

/// Key of VolumeInfo::extra for the scale of the values, if it affects the colours. One of:
constexpr const char* kScaleKey = "scale";
constexpr const char* kProbabilityScale = "probability";  ///< 0..1
constexpr const char* kRatioBelowScale = "ratio, below";  ///< dB about 0; values below 0 are of interest
constexpr const char* kRatioAboveScale = "ratio, above";  ///< dB about 0; values above 0 are of interest
constexpr const char* kDifferenceScale = "difference";    ///< of two fields, about 0

/// Key of VolumeInfo::extra: a line for the legend, about values at the end of the range.
constexpr const char* kLegendNoteKey = "legend_note";

/// Values in dense order. Voxels below ground or without a known field are masked: they hold `info.floor`,
/// are inactive in .vdb and are never drawn.
struct DenseVolume {
  Grid grid;
  VolumeInfo info;
  UnsetVector<float> values;  ///< grid.dims.count() values
  /// For each column (i, j), i fastest: the lowest k with a field; dims.z if there is none. Empty: no voxel
  /// is masked.
  std::vector<std::uint16_t> first_valid_k;

  bool isMasked(int i, int j, int k) const {
    return !first_valid_k.empty() && k < first_valid_k[static_cast<std::size_t>(j) * grid.dims.x + i];
  }
};

constexpr int kMaxVoxelsPerAxis = 65535;     ///< first_valid_k counts in 16 bits
constexpr long long kMaxVoxels = 1LL << 32;  ///< 16 GiB of values

/// @param who  beginning of the error that names the volume: "volume snr_db: "
/// @throws Error (bad_input) at `location` if one of the dims or their product exceeds the limits above
void checkDims(const Dims& dims, const SourceLocation& location, const std::string& who = "");

/// Checks that a volume has a name, one value per voxel and, if it has a mask, one entry per column, and that
/// spacing, place, frame, time and range are within their limits.
/// @throws Error (bad_input) at `location`, the file being read or written
void checkVolume(const DenseVolume& volume, const SourceLocation& location);

/// The values of a categorical volume as whole numbers; NaN becomes the floor.
/// @throws Error (bad_input) at `location` for values that are not whole numbers, or above 2^24, where floats
/// are not exact
std::vector<std::int32_t> toIndices(const DenseVolume& volume, const SourceLocation& location);

}  // namespace emscape::volume
