/// Volumes as OpenVDB grids.
///
/// One grid a quantity, named by it: a FloatGrid, or an Int32Grid for categorical quantities; class "fog
/// volume"; index (i, j, k) maps to that voxel's centre in the frame's metres; the background is the floor. A
/// voxel is active where it holds a field: it is not masked and its value is not the floor (so NaN is
/// active). What a grid needs to become the same volume again stands in its metadata:
///
///   emscape:quantity, :unit, :time_utc  string        emscape:time_s  double
///   emscape:floor, :range_min, :range_max  float       emscape:categorical  bool
///   emscape:dims  vec3i (the tree says only where voxels are active); :voxel_count  int64, their product
///   emscape:frame  string; :origin_latitude_deg, :origin_longitude_deg, :origin_height_msl_m  double (where
///   georeferenced) emscape:first_valid_k  bytes: the mask, 16 bits a column, little endian (where there is
///   one) emscape:KEY  string, for each entry of VolumeInfo::extra (scenario_hash, version, ...)
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Writes one grid for each volume. @throws Error; then there is no file, or the one that was there before
void writeVdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// Reads a grid: one that writeVdb() wrote exactly, one of another program (float, double, int32 or int64;
/// saved as half or not; any linear transform, whose rotation is lost) over the box of its active voxels,
/// unlike ours not georeferenced, with its background for a floor. A level set is read as the distances that
/// it holds.
/// @param grid_name  empty: the first grid
/// @throws Error (bad_input), which lists the file's grids where it has none of that name
DenseVolume readVdb(const std::filesystem::path& path, const std::string& grid_name = "");

/// What each grid holds, without values and mask.
std::vector<DenseVolume> describeVdb(const std::filesystem::path& path);

}  // namespace emscape::volume
