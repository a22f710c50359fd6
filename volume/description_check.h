/// Checks of what files state about volumes and fields on meshes; the same for all formats. Internal to the
/// module.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Limits of the distance of voxels (m).
constexpr double kMinSpacing_m = 1e-20;
constexpr double kMaxSpacing_m = 1e20;
/// Limit of a coordinate of the first voxel, as a multiple of the spacing, which doubles resolve there.
constexpr double kMaxFirstVoxel = 1e12;

/// Checks dims, spacing, place and, if georeferenced, frame.
/// @param who  beginning of errors that names the grid: "volume snr_db: "; may be empty
/// @throws Error (bad_input) at `location` with value and allowed range
void checkGrid(const Grid& grid, const std::string& who, const SourceLocation& location);

/// Checks latitude, longitude and height.
/// @throws Error (bad_input) as checkGrid()
void checkFrame(const FrameOrigin& frame, const std::string& who, const SourceLocation& location);

/// Checks the time and the range.
/// @throws Error (bad_input) as checkGrid()
void checkInfo(const VolumeInfo& info, const std::string& who, const SourceLocation& location);

/// Checks a time (s).
/// @param name  of the time in errors
/// @throws Error (bad_input) beyond kMaxTime_s, or for NaN
void checkTime(double time_s, const std::string& name, const SourceLocation& location);

/// The value as float, which may be infinite or NaN.
/// @param name  of the value in errors; may be empty
/// @throws Error (bad_input), without a location, for finite values beyond the floats
float requireFloat(double value, const std::string& name = "");

/// Checks that voxels lie along the axes of the frame: that the matrix from indices to positions has the
/// spacing on its diagonal and 0 elsewhere, each within 1e-6 of the smallest spacing.
/// @param matrix  row-major
/// @param who     as of checkGrid()
/// @throws Error (bad_input) at `location`: the grid is rotated, sheared or mirrored
void checkAxes(const std::array<double, 9>& matrix, const Vec3d& spacing_m, const std::string& who,
               const SourceLocation& location);

/// A file of another program may be so sparse that the box of its active voxels is very large, or have large
/// tiles of one value. Beyond 2^27 voxels at least one in a thousand must be stored; else the file is
/// probably damaged.
/// @param stored  number of active voxels and tiles with a value in the file
/// @throws Error (bad_input) at `location`
void checkSparseness(const Dims& dims, std::uint64_t stored, const SourceLocation& location);

/// Checks that there is memory for the values of a dense volume, however small the file is.
/// @throws Error (other) at `location`
void requireDenseMemory(const Dims& dims, const SourceLocation& location);

}  // namespace emscape::volume
