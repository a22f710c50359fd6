/// Volumes as OpenVDB grids.
///
/// One grid per quantity, named by it: a FloatGrid of the class "fog volume", or an Int32Grid without a class
/// for categorical quantities; index (i, j, k) maps to that voxel's centre in the frame's metres; the
/// background is the floor. A voxel is active if it holds a field: it is not masked and its value is not the
/// floor (so NaN is active).
/// Its metadata contain everything that is needed to read the same volume again:
///
///   emscape:quantity, :unit, :time_utc  string        emscape:time_s  double
///   emscape:floor, :range_min, :range_max  float       emscape:categorical  bool
///   emscape:dims  vec3i (the tree covers only active voxels); :voxel_count  int64, their product
///   emscape:spacing_m  vec3d, by which a coarser copy is recognised; missing in files up to version 0.2.0
///   emscape:frame  string; :origin_latitude_deg, :origin_longitude_deg, :origin_height_msl_m  double (where
///   georeferenced) emscape:first_valid_k  bytes: the mask, 16 bits per column, little endian (if there is
///   one) emscape:KEY  string, for each entry of VolumeInfo::extra (scenario_hash, version, ...)
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Loads OpenVDB, which is else loaded at the first use. @throws Error if it cannot be loaded
void requireVdb();

/// Writes one grid for each volume. @throws Error; an earlier file of that name is then unchanged
void writeVdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// Reads a grid: one that writeVdb() wrote exactly, one of another program (float, double, int32 or int64;
/// saved as half or not; any linear transform, whose rotation is lost) over the box of its active voxels,
/// not georeferenced, with its background as the floor. A level set is read as its distances. Of a grid with
/// another name or spacing than in its metadata, or active voxels outside its dims, the metadata are ignored,
/// with a warning.
/// @param grid_name  empty: the first grid that can be read
/// @throws Error (bad_input), which lists the file's grids if none has that name
DenseVolume readVdb(const std::filesystem::path& path, const std::string& grid_name = "");

/// The grids without values and mask. Those that cannot be read are left out, with a warning.
/// @throws Error (bad_input) if none can be read
std::vector<DenseVolume> describeVdb(const std::filesystem::path& path);

}  // namespace emscape::volume
