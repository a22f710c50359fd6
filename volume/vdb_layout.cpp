#include "volume/vdb_layout.h"

#include <bitset>

namespace emscape::volume {
namespace {

constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222;
constexpr std::uint32_t kNewestVersion = 224;
constexpr char kNameSeparator = '\x1e';
constexpr char kHalfSuffix[] = "_HalfFloat";

enum Compression : std::uint32_t { kZip = 1, kActiveMask = 2, kBlosc = 4 };

/// Storage of a node's inactive values, from the byte before its values: the background or its negative,
/// other given values, or one of two by a mask; or all values are stored.
enum ValueKind : std::int8_t {
  kBackground = 0,
  kMinusBackground = 1,
  kOneInactive = 2,
  kMaskOfSigns = 3,
  kMaskAndOneInactive = 4,
  kMaskAndTwoInactive = 5,
  kAllValues = 6,
};

/// Log2 of the nodes' edges, from the root's children to the leaves.
constexpr int kUpperLog2 = 5, kLowerLog2 = 4, kLeafLog2 = 3;
/// Edge of a root's child (voxels); the root's keys are multiples of it.
constexpr std::int32_t kUpperEdge = 1 << (kUpperLog2 + kLowerLog2 + kLeafLog2);
/// Coordinates beyond this limit are due to damage, and would overflow in the computation of boxes.
constexpr std::int32_t kFarthest = 1 << 28;

class TreeWalk {
 public:
  TreeWalk(ByteReader& reader, VdbVoxel voxel, bool is_half, std::uint32_t compression)
      : reader_(reader),
        voxel_bytes_(static_cast<std::uint64_t>(voxel.bytes)),
        half_(is_half && voxel.real),
        compression_(compression) {}

  void run() {
    if (reader_.value<std::int32_t>("number of buffers") != 1) reader_.fail("a tree of more than one buffer");
    reader_.take(voxel_bytes_, "background value");
    const auto tiles = reader_.value<std::uint32_t>("number of root tiles");
    const auto children = reader_.value<std::uint32_t>("number of root nodes");
    for (std::uint32_t i = 0; i < tiles; ++i) {
      origin();
      reader_.take(voxel_bytes_, "root tile");
      if (reader_.value<std::uint8_t>("root tile") > 1)
        reader_.fail("a root tile is neither active nor inactive");
    }
    for (std::uint32_t i = 0; i < children; ++i) {
      origin();
      internalNode(kUpperLog2);
    }
    for (std::uint64_t i = 0; i < leaves_; ++i) {
      const std::uint8_t* mask = reader_.take(maskBytes(kLeafLog2), "leaf mask");
      values(kLeafLog2, mask);
    }
  }

 private:
  static std::uint64_t valueCount(int log2) { return std::uint64_t(1) << (3 * log2); }
  static std::uint64_t maskBytes(int log2) { return valueCount(log2) / 8; }
  static std::uint64_t countOn(const std::uint8_t* mask, int log2) {
    std::uint64_t count = 0;
    for (std::uint64_t i = 0; i < maskBytes(log2); ++i) count += std::bitset<8>(mask[i]).count();
    return count;
  }

  void origin() {
    for (int axis = 0; axis < 3; ++axis) {
      const auto coordinate = reader_.value<std::int32_t>("root key");
      if (coordinate % kUpperEdge != 0 || coordinate > kFarthest || coordinate < -kFarthest) {
        reader_.fail("a root node at " + std::to_string(coordinate));
      }
    }
  }

  void internalNode(int log2) {
    const std::uint8_t* child_mask = reader_.take(maskBytes(log2), "child mask");
    const std::uint8_t* value_mask = reader_.take(maskBytes(log2), "value mask");
    values(log2, value_mask);
    const std::uint64_t children = countOn(child_mask, log2);
    if (log2 == kLowerLog2) {
      reader_.take(children * maskBytes(kLeafLog2), "leaf masks");
      leaves_ += children;
      return;
    }
    for (std::uint64_t i = 0; i < children; ++i) internalNode(kLowerLog2);
  }

  /// The values of a node; inactive ones may be left out.
  void values(int log2, const std::uint8_t* value_mask) {
    const auto kind = reader_.value<std::int8_t>("kind of a node's values");
    if (kind < 0 || kind > kAllValues) reader_.fail("unknown kind " + std::to_string(kind) + " of values");
    const bool one_value = kind == kOneInactive || kind == kMaskAndOneInactive;
    const bool two_values = kind == kMaskAndTwoInactive;
    const bool selection = kind == kMaskOfSigns || kind == kMaskAndOneInactive || kind == kMaskAndTwoInactive;
    reader_.take(voxel_bytes_ * (two_values ? 2 : one_value ? 1 : 0), "inactive values");
    reader_.take(selection ? maskBytes(log2) : 0, "mask of inactive values");
    const bool left_out = (compression_ & kActiveMask) != 0 && kind != kAllValues;
    const std::uint64_t count = left_out ? countOn(value_mask, log2) : valueCount(log2);
    if (half_ && count == 0) return;
    buffer(count * (half_ ? 2 : voxel_bytes_));
  }

  void buffer(std::uint64_t bytes) {
    if ((compression_ & (kBlosc | kZip)) == 0) {
      reader_.take(bytes, "voxels");
      return;
    }
    const auto stored = reader_.value<std::int64_t>("size of voxels");
    if (stored <= 0) {  // stored uncompressed, with the negated size
      if (static_cast<std::uint64_t>(-(stored + 1)) + 1 != bytes) {
        reader_.fail("a buffer of " + std::to_string(stored) + " bytes where " + std::to_string(bytes) +
                     " are needed");
      }
      reader_.take(bytes, "voxels");
      return;
    }
    const std::uint8_t* begin = reader_.take(static_cast<std::uint64_t>(stored), "compressed voxels");
    if ((compression_ & kBlosc) != 0) checkBlosc(begin, static_cast<std::uint64_t>(stored), bytes);
  }

  /// Blosc trusts its own header, so it must agree with the sizes around it.
  void checkBlosc(const std::uint8_t* begin, std::uint64_t stored, std::uint64_t bytes) {
    ByteReader header(reader_.file(), begin, stored);
    header.take(4, "compressed voxels");
    const auto full_bytes = header.value<std::uint32_t>("compressed voxels");
    const auto block_bytes = header.value<std::uint32_t>("compressed voxels");
    const auto compressed_bytes = header.value<std::uint32_t>("compressed voxels");
    if (full_bytes != bytes || block_bytes == 0 || compressed_bytes != stored) {
      reader_.fail("the header of compressed voxels does not match their size");
    }
  }

  ByteReader& reader_;
  std::uint64_t voxel_bytes_;
  bool half_;
  std::uint32_t compression_;
  std::uint64_t leaves_ = 0;
};

template <class Value>
Value fromBytes(const std::string& bytes) {
  Value value;
  std::memcpy(&value, bytes.data(), sizeof(Value));
  return value;
}

/// The type's value at a key, if there is one of the right size.
template <class Value>
std::optional<Value> metaValue(const VdbMetadata& metadata, const std::string& key, const char* type) {
  const auto found = metadata.find(key);
  if (found == metadata.end() || found->second.type != type || found->second.bytes.size() != sizeof(Value)) {
    return std::nullopt;
  }
  return fromBytes<Value>(found->second.bytes);
}

}  // namespace

VdbHeader readVdbHeader(ByteReader& reader) {
  if (reader.left() < sizeof(kMagic) || reader.value<std::int64_t>("magic number") != kMagic) {
    throw Error(ErrorCode::bad_input, {reader.file()}, "no OpenVDB file");
  }
  VdbHeader header;
  header.file_version = reader.value<std::uint32_t>("version");
  if (header.file_version < kOldestVersion || header.file_version > kNewestVersion) {
    throw Error(ErrorCode::bad_input, {reader.file()},
                "OpenVDB file version " + std::to_string(header.file_version) + ": versions " +
                    std::to_string(kOldestVersion) + " to " + std::to_string(kNewestVersion) +
                    " can be read");
  }
  header.library_major = reader.value<std::uint32_t>("library version");
  header.library_minor = reader.value<std::uint32_t>("library version");
  header.has_offsets = reader.value<std::uint8_t>("header") != 0;
  reader.take(kVdbUuidBytes, "identifier");
  readVdbMetadata(reader);
  header.grid_count = reader.value<std::int32_t>("number of grids");
  return header;
}

VdbDescriptor readVdbDescriptor(ByteReader& reader, const VdbHeader& header) {
  VdbDescriptor descriptor;
  descriptor.unique_name = reader.text("grid name");
  const std::size_t separator = descriptor.unique_name.find(kNameSeparator);
  descriptor.own_name = descriptor.unique_name.substr(0, separator);
  descriptor.name = descriptor.own_name;
  if (separator != std::string::npos) {
    descriptor.name += "[" + descriptor.unique_name.substr(separator + 1) + "]";
  }
  descriptor.type = reader.text("grid type");
  const std::size_t suffix = descriptor.type.rfind(kHalfSuffix);
  if (suffix != std::string::npos) {
    descriptor.half = true;
    descriptor.type.resize(suffix);
  }
  descriptor.instance_parent = reader.text("name of the parent grid");
  reader.take(2 * sizeof(std::int64_t), "grid offsets");
  const auto end = reader.value<std::uint64_t>("grid offsets");
  if (header.has_offsets) {
    if (end < reader.position() || end > reader.size()) {
      reader.fail("grid " + descriptor.name + " ends at offset " + std::to_string(end) + ", the file has " +
                  std::to_string(reader.size()) + " bytes");
    }
    descriptor.end = end;
  }
  return descriptor;
}

VdbMetadata readVdbMetadata(ByteReader& reader) {
  VdbMetadata metadata;
  const auto count = reader.value<std::uint32_t>("number of metadata");
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string key = reader.text("name of metadata");
    VdbMetaValue value;
    value.type = reader.text("type of metadata");
    value.offset = reader.position() + sizeof(std::uint32_t);  // after the length
    value.bytes = reader.text("metadata");
    metadata[key] = std::move(value);
  }
  return metadata;
}

std::optional<std::string> metaText(const VdbMetadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  if (found == metadata.end() || found->second.type != "string") return std::nullopt;
  return found->second.bytes;
}

std::optional<double> metaNumber(const VdbMetadata& metadata, const std::string& key) {
  if (const auto value = metaValue<double>(metadata, key, "double")) return *value;
  if (const auto value = metaValue<float>(metadata, key, "float")) return *value;
  if (const auto value = metaValue<std::int32_t>(metadata, key, "int32")) return *value;
  if (const auto value = metaValue<std::int64_t>(metadata, key, "int64")) return static_cast<double>(*value);
  if (const auto value = metaValue<std::uint8_t>(metadata, key, "bool")) return *value != 0;
  return std::nullopt;
}

std::optional<VdbInts> metaInts(const VdbMetadata& metadata, const std::string& key) {
  return metaValue<VdbInts>(metadata, key, "vec3i");
}

std::optional<VdbDoubles> metaDoubles(const VdbMetadata& metadata, const std::string& key) {
  return metaValue<VdbDoubles>(metadata, key, "vec3d");
}

std::optional<VdbVoxel> vdbVoxelOf(const std::string& grid_type) {
  static const std::map<std::string, VdbVoxel> kVoxels = {{"Tree_float_5_4_3", {4, true}},
                                                          {"Tree_double_5_4_3", {8, true}},
                                                          {"Tree_int32_5_4_3", {4, false}},
                                                          {"Tree_int64_5_4_3", {8, false}}};
  const auto found = kVoxels.find(grid_type);
  if (found == kVoxels.end()) return std::nullopt;
  return found->second;
}

void walkVdbTree(ByteReader& reader, VdbVoxel voxel, bool half, std::uint32_t compression) {
  TreeWalk(reader, voxel, half, compression).run();
}

}  // namespace emscape::volume
