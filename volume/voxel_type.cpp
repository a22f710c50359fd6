#include "volume/voxel_type.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "emscape/base/parallel.h"

namespace emscape::volume {
namespace {

struct TypeRow {
  VoxelType type;
  const char* name;
  int bytes;
};

constexpr TypeRow kTypes[] = {
    {VoxelType::int8, "int8", 1},       {VoxelType::uint8, "uint8", 1},     {VoxelType::int16, "int16", 2},
    {VoxelType::uint16, "uint16", 2},   {VoxelType::int32, "int32", 4},     {VoxelType::uint32, "uint32", 4},
    {VoxelType::float32, "float32", 4}, {VoxelType::float64, "float64", 8},
};

const TypeRow& rowOf(VoxelType type) {
  return kTypes[static_cast<int>(type)];
}

template <class Source>
UnsetVector<float> convert(const std::uint8_t* bytes, std::size_t count, bool big_endian) {
  constexpr std::size_t kPiece = 1 << 16;
  UnsetVector<float> floats(count);
  const int pieces = static_cast<int>((count + kPiece - 1) / kPiece);
  parallelFor(pieces, 1, [&](int begin, int end) {
    const std::size_t last = std::min(count, end * kPiece);
    for (std::size_t i = begin * kPiece; i < last; ++i) {
      std::uint8_t voxel[sizeof(Source)];
      std::memcpy(voxel, bytes + i * sizeof(Source), sizeof(Source));
      if (big_endian) std::reverse(std::begin(voxel), std::end(voxel));
      Source value;
      std::memcpy(&value, voxel, sizeof(Source));
      floats[i] = static_cast<float>(value);
    }
  });
  return floats;
}

}  // namespace

const char* toString(VoxelType type) {
  return rowOf(type).name;
}

int bytesOf(VoxelType type) {
  return rowOf(type).bytes;
}

std::optional<VoxelType> voxelTypeFromName(const std::string& name) {
  for (const TypeRow& row : kTypes) {
    if (name == row.name) return row.type;
  }
  return std::nullopt;
}

std::string voxelTypeNames() {
  std::string names;
  for (const TypeRow& row : kTypes) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

UnsetVector<float> toFloats(const std::uint8_t* bytes, std::size_t count, VoxelType type, bool big_endian) {
  switch (type) {
    case VoxelType::int8:
      return convert<std::int8_t>(bytes, count, big_endian);
    case VoxelType::uint8:
      return convert<std::uint8_t>(bytes, count, big_endian);
    case VoxelType::int16:
      return convert<std::int16_t>(bytes, count, big_endian);
    case VoxelType::uint16:
      return convert<std::uint16_t>(bytes, count, big_endian);
    case VoxelType::int32:
      return convert<std::int32_t>(bytes, count, big_endian);
    case VoxelType::uint32:
      return convert<std::uint32_t>(bytes, count, big_endian);
    case VoxelType::float32:
      return convert<float>(bytes, count, big_endian);
    case VoxelType::float64:
      break;
  }
  return convert<double>(bytes, count, big_endian);
}

}  // namespace emscape::volume
