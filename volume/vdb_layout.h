/// Check of a .vdb file's layout on the disk, byte by byte, before OpenVDB reads it: OpenVDB trusts the sizes
/// in a file; with a damaged file it would write beyond its buffers or allocate without limit. Internal to
/// the module; does not use OpenVDB.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "volume/byte_reader.h"

namespace emscape::volume {

/// Position of a file's identifier, a UUID as text.
constexpr int kVdbUuidOffset = 21, kVdbUuidBytes = 36;

struct VdbHeader {
  std::uint32_t file_version = 0;
  std::uint32_t library_major = 0, library_minor = 0;
  bool has_offsets = false;  ///< descriptors have the ends of grids
  int grid_count = 0;
};

/// Reads the header and the file's own metadata; the grids follow.
/// @throws Error (bad_input) for a file that is not .vdb, or of a version before 222 (OpenVDB 1.0) or after
/// 224
VdbHeader readVdbHeader(ByteReader& reader);

struct VdbDescriptor {
  std::string unique_name;  ///< with a hidden suffix that distinguishes grids of one name
  std::string own_name;     ///< without it: "density"
  std::string name;         ///< for display: "density" or "density[1]"
  std::string type;         ///< for example Tree_float_5_4_3
  std::string
      instance_parent;  ///< unique name of the grid whose tree this one shares; empty: it has a separate tree
  bool half = false;    ///< floating-point values are stored in 16 bits
  std::uint64_t end = 0;  ///< offset of the end of the grid; 0 if the file has no offsets
};

VdbDescriptor readVdbDescriptor(ByteReader& reader, const VdbHeader& header);

/// Position of one value of a grid's metadata in the file.
struct VdbMetaValue {
  std::string type;
  std::string bytes;
  std::uint64_t offset = 0;  ///< of the bytes, in the file
};
using VdbMetadata = std::map<std::string, VdbMetaValue>;

VdbMetadata readVdbMetadata(ByteReader& reader);

std::optional<std::string> metaText(const VdbMetadata& metadata, const std::string& key);
/// A float, double, int32, int64 or bool.
std::optional<double> metaNumber(const VdbMetadata& metadata, const std::string& key);
struct VdbInts {
  std::int32_t x, y, z;
};
std::optional<VdbInts> metaInts(const VdbMetadata& metadata, const std::string& key);
struct VdbDoubles {
  double x, y, z;
};
std::optional<VdbDoubles> metaDoubles(const VdbMetadata& metadata, const std::string& key);

/// Types of voxels whose trees can be walked; empty for others.
struct VdbVoxel {
  int bytes = 0;
  bool real = false;
};
std::optional<VdbVoxel> vdbVoxelOf(const std::string& grid_type);

/// Walks a tree's topology and buffers from the reader's position to their end and checks every size on the
/// way.
/// @param compression  of the grid: OpenVDB's flags
/// @throws Error (bad_input)
void walkVdbTree(ByteReader& reader, VdbVoxel voxel, bool half, std::uint32_t compression);

}  // namespace emscape::volume
