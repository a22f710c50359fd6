/// Volumes as bare voxels: .raw with a JSON sidecar as header or the layout in the file name, and .dat.
#pragma once

#include <filesystem>
#include <optional>

#include "emscape/volume/dense_volume.h"
#include "volume/voxel_type.h"

namespace emscape::volume {

/// Layout of a .raw file without a header. Voxels are stored x fastest, then y, then z.
struct RawLayout {
  Dims dims;
  VoxelType type = VoxelType::uint8;
  Vec3d spacing_m{1, 1, 1};
  bool big_endian = false;
};

/// Writes PATH (float32, or int32 for a categorical volume; little endian) and its header PATH.json, both or
/// neither.
/// @throws Error
void writeRaw(const std::filesystem::path& path, const DenseVolume& volume);

/// The layout in names such as engine_256x256x110_uint8.raw.
std::optional<RawLayout> rawLayoutFromName(const std::filesystem::path& path);

/// Reads a .raw file: by its header PATH.json if there is one, else by the layout in its name.
/// @throws Error (bad_input), among others if the file's size does not match the layout
DenseVolume readRaw(const std::filesystem::path& path);

/// Reads a .raw file without a header. The floor is 0, the range that of the values.
DenseVolume readRaw(const std::filesystem::path& path, const RawLayout& layout);

/// Reads a .dat file: three little-endian uint16 sizes, then uint16 voxels.
DenseVolume readDat(const std::filesystem::path& path);

/// The volume without its values. @throws Error (bad_input)
DenseVolume describeRaw(const std::filesystem::path& path);
DenseVolume describeDat(const std::filesystem::path& path);

}  // namespace emscape::volume
