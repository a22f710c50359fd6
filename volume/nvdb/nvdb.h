/// Volumes as NanoVDB grids, for GPUs, with a sidecar.
///
/// PATH holds one grid per quantity, as in a .vdb file (vdb.h), uncompressed. NanoVDB has no metadata; the
/// sidecar PATH.json contains them: {"volumes": [...]}, each with its grid, info and mask.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Writes PATH and PATH.json, both or neither. @throws Error
void writeNvdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);

/// Reads a grid: with its sidecar exactly what was written; without one, or a grid that it does not name,
/// over the box of the active voxels. Float, double, int32 and int64 grids without compression can be read.
/// @param grid_name  empty: the first grid that can be read
/// @throws Error (bad_input), which lists the file's grids if none has that name
DenseVolume readNvdb(const std::filesystem::path& path, const std::string& grid_name = "");

/// The grids without values and mask. Those that cannot be read are left out, with a warning.
/// @throws Error (bad_input) if none can be read
std::vector<DenseVolume> describeNvdb(const std::filesystem::path& path);

}  // namespace emscape::volume
