#include "volume/format/raw.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>

#include "base/files/file_reading.h"
#include "base/files/inputs.h"
#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "emscape/volume/statistics.h"
#include "volume/byte_reader.h"
#include "volume/volume_json.h"

namespace emscape::volume {
namespace fs = std::filesystem;
namespace {

constexpr char kOrder[] = "x fastest, then y, then z";

/// A volume without values, and their layout in the file.
struct Described {
  DenseVolume volume;
  VoxelType type = VoxelType::uint8;
  bool big_endian = false;
  std::uint64_t offset = 0;  ///< of the first voxel
  bool has_range = false;    ///< the header has the range
};

std::string textOf(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = readWhole(path);
  return {bytes.begin(), bytes.end()};
}

Described describeByHeader(const fs::path& header) {
  const std::string file = header.string();
  const nlohmann::ordered_json json = parseJson(textOf(header), file);
  Described described;
  described.volume = fromJson(json, file);
  described.has_range = json.contains("range_min") && json.contains("range_max");
  const auto type_name = requiredFromJson<std::string>(json, "type", file);
  const std::optional<VoxelType> type = voxelTypeFromName(type_name);
  if (!type) {
    throw Error(ErrorCode::bad_input, {file},
                "type \"" + type_name + "\" must be one of " + voxelTypeNames());
  }
  described.type = *type;
  const auto endianness = requiredFromJson<std::string>(json, "endianness", file);
  if (endianness != "little" && endianness != "big") {
    throw Error(ErrorCode::bad_input, {file}, "endianness \"" + endianness + "\" is neither little nor big");
  }
  described.big_endian = endianness == "big";
  const auto order = requiredFromJson<std::string>(json, "order", file);
  if (order != kOrder) {
    throw Error(ErrorCode::bad_input, {file}, "order \"" + order + "\": only \"" + kOrder + "\" is known");
  }
  if (described.volume.info.quantity.empty()) described.volume.info.quantity = header.stem().stem().string();
  return described;
}

std::string quantityFromName(const fs::path& path) {
  static const std::regex kLayout("[_-]?[0-9]{1,9}x[0-9]{1,9}x[0-9]{1,9}");
  const std::string stem = path.stem().string();
  std::smatch layout;
  const std::string name = std::regex_search(stem, layout, kLayout) ? layout.prefix().str() : stem;
  return name.empty() ? stem : name;
}

Described describeByLayout(const fs::path& path, const RawLayout& layout) {
  Described described;
  described.volume.grid.dims = layout.dims;
  described.volume.grid.spacing_m = layout.spacing_m;
  described.volume.info.quantity = quantityFromName(path);
  described.volume.info.has_time = false;
  described.type = layout.type;
  described.big_endian = layout.big_endian;
  checkDims(layout.dims, {path.string()});
  return described;
}

Described describe(const fs::path& path) {
  std::error_code ignored;  // the name of the header may be too long
  if (fs::exists(sidecarOf(path), ignored)) return describeByHeader(sidecarOf(path));
  const std::optional<RawLayout> layout = rawLayoutFromName(path);
  if (!layout) {
    throw Error(ErrorCode::bad_input, {path.string()},
                "dims and type are unknown: there is no header " + sidecarOf(path).string() +
                    ", and the name does not end in _XxYxZ_TYPE.raw, for example _256x256x110_uint8.raw");
  }
  return describeByLayout(path, *layout);
}

Described describeDatFile(const fs::path& path) {
  // A stream would wait for the other end of a pipe.
  if (inputExists(path) && !fs::is_regular_file(path))
    throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: it is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  std::uint8_t head[6] = {};
  stream.read(reinterpret_cast<char*>(head), sizeof(head));
  ByteReader reader(path.string(), head, static_cast<std::uint64_t>(stream.gcount()));
  RawLayout layout;
  layout.type = VoxelType::uint16;
  layout.dims.x = reader.value<std::uint16_t>("size in x");
  layout.dims.y = reader.value<std::uint16_t>("size in y");
  layout.dims.z = reader.value<std::uint16_t>("size in z");
  Described described = describeByLayout(path, layout);
  described.offset = reader.position();
  return described;
}

/// Before anything is allocated for them.
void checkSize(const fs::path& path, const Described& described) {
  const Dims& dims = described.volume.grid.dims;
  std::error_code error;
  const std::uintmax_t found = fs::file_size(path, error);
  if (error) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + error.message());
  const std::uintmax_t expected =
      described.offset + static_cast<std::uintmax_t>(dims.count()) * bytesOf(described.type);
  if (found != expected) {
    throw Error(ErrorCode::bad_input, {path.string()},
                "expected " + std::to_string(expected) + " bytes for " + std::to_string(dims.x) + " x " +
                    std::to_string(dims.y) + " x " + std::to_string(dims.z) + " voxels of " +
                    toString(described.type) + ", found " + std::to_string(found));
  }
}

DenseVolume read(const fs::path& path, Described described) {
  checkSize(path, described);
  const std::vector<std::uint8_t> bytes = readWhole(path);
  const auto count = static_cast<std::size_t>(described.volume.grid.dims.count());
  if (bytes.size() != described.offset + count * bytesOf(described.type)) {
    throw Error(ErrorCode::bad_input, {path.string()}, "changed while it was read");
  }
  DenseVolume volume = std::move(described.volume);
  volume.values = toFloats(bytes.data() + described.offset, count, described.type, described.big_endian);
  checkVolume(volume, {path.string()});
  if (!described.has_range) setRangeFromValues(volume);
  return volume;
}

}  // namespace

void writeRaw(const fs::path& path, const DenseVolume& volume) {
  checkVolume(volume, {path.string()});
  const bool categorical = volume.info.categorical;
  nlohmann::ordered_json header = toJson(volume, true);
  header["type"] = toString(categorical ? VoxelType::int32 : VoxelType::float32);
  header["order"] = kOrder;
  header["endianness"] = "little";
  const auto writeVoxels = [&](std::ostream& stream) {
    const auto bytes = static_cast<std::streamsize>(volume.values.size() * sizeof(float));
    if (categorical) {
      const std::vector<std::int32_t> indices = toIndices(volume, {path.string()});
      stream.write(reinterpret_cast<const char*>(indices.data()), bytes);
    } else {
      stream.write(reinterpret_cast<const char*>(volume.values.data()), bytes);
    }
  };
  writeWhole({{sidecarOf(path), [&](std::ostream& stream) { stream << dumpJson(header, 2) << '\n'; }},
              {path, writeVoxels}});
}

std::optional<RawLayout> rawLayoutFromName(const fs::path& path) {
  static const std::regex kName(".*?([0-9]{1,9})x([0-9]{1,9})x([0-9]{1,9})_([a-z]+[0-9]+)\\.raw");
  constexpr std::size_t kMaxLayout = 64;  // std::regex uses the stack for each character
  std::smatch parts;
  const std::string name = path.filename().string();
  const std::string end = name.substr(name.size() - std::min(name.size(), kMaxLayout));
  if (!std::regex_match(end, parts, kName)) return std::nullopt;
  const std::optional<VoxelType> type = voxelTypeFromName(parts[4]);
  if (!type) return std::nullopt;
  RawLayout layout;
  layout.dims = {std::stoi(parts[1]), std::stoi(parts[2]), std::stoi(parts[3])};
  layout.type = *type;
  return layout;
}

DenseVolume readRaw(const fs::path& path) {
  return read(path, describe(path));
}

DenseVolume readRaw(const fs::path& path, const RawLayout& layout) {
  return read(path, describeByLayout(path, layout));
}

DenseVolume readDat(const fs::path& path) {
  return read(path, describeDatFile(path));
}

DenseVolume describeRaw(const fs::path& path) {
  Described described = describe(path);
  checkSize(path, described);
  return std::move(described.volume);
}

DenseVolume describeDat(const fs::path& path) {
  Described described = describeDatFile(path);
  checkSize(path, described);
  return std::move(described.volume);
}

}  // namespace emscape::volume
