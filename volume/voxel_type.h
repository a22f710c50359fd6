/// Types that voxels have in files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "emscape/base/unset_vector.h"

namespace emscape::volume {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Name in file names and headers, for example "uint8".
const char* toString(VoxelType type);
std::optional<VoxelType> voxelTypeFromName(const std::string& name);
/// All names, with commas between them.
std::string voxelTypeNames();

int bytesOf(VoxelType type);

/// Converts `count` voxels to float, in parallel. @param bytes  count * bytesOf(type), of any alignment
UnsetVector<float> toFloats(const std::uint8_t* bytes, std::size_t count, VoxelType type, bool big_endian);

}  // namespace emscape::volume
