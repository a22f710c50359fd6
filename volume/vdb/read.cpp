#include <openvdb/io/io.h>
#include <openvdb/tools/Dense.h>

#include <array>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/stream.hpp>
#include <cmath>
#include <set>

#include "base/files/file_reading.h"
#include "base/text/failure_text.h"
#include "emscape/volume/statistics.h"
#include "volume/description_check.h"
#include "volume/foreign.h"
#include "volume/format/vdb_functions.h"
#include "volume/vdb/grid.h"
#include "volume/vdb_layout.h"

namespace emscape::volume::vdb {
namespace {

/// A file's bytes from the reader's position on, as a stream for OpenVDB. Reading beyond the end throws.
class MemoryStream : public boost::iostreams::stream<boost::iostreams::array_source> {
 public:
  explicit MemoryStream(const ByteReader& reader)
      : stream(reinterpret_cast<const char*>(reader.here()), reader.left()) {
    exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
  }
};

struct VdbGrid {
  VdbDescriptor descriptor;
  std::uint32_t compression = 0;
  VdbMetadata metadata;
  openvdb::math::Transform::Ptr transform;
  std::uint64_t tree = 0;  ///< offset of the tree
};

class VdbFile {
 public:
  explicit VdbFile(const std::filesystem::path& path)
      : bytes_(readWhole(path)), reader_(path.string(), bytes_.data(), bytes_.size()) {
    initializeOpenVdb();
    header_ = readVdbHeader(reader_);
    for (int i = 0; i < header_.grid_count; ++i) {
      const VdbGrid& entry = entries_.emplace_back(readEntry());
      if (header_.has_offsets) {
        reader_.seek(entry.descriptor.end, "the next grid");
      } else if (i + 1 < header_.grid_count && entry.descriptor.instance_parent.empty()) {
        walkTree(entry);
      }
    }
    if (entries_.empty()) fail("the file has no grid");
  }

  const std::vector<VdbGrid>& entries() const { return entries_; }

  const VdbGrid& find(const std::string& name) const {
    std::vector<std::string> names;
    for (const VdbGrid& entry : entries_) names.push_back(entry.descriptor.name);
    return entries_[indexOfName(names, name, kUnnamedGrid, "grid", reader_.file())];
  }

  /// The grid with its tree, all of it checked before OpenVDB reads it.
  openvdb::GridBase::Ptr load(const VdbGrid& entry) {
    const VdbGrid& owner = ownerOfTree(entry);
    reader_.seek(owner.tree, "tree");
    walkTree(owner);
    reader_.seek(owner.tree, "tree");
    MemoryStream stream(reader_);
    prepare(stream, owner.compression);
    const openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(owner.descriptor.type);
    grid->setSaveFloatAsHalf(owner.descriptor.half);
    grid->readTopology(stream);
    grid->readBuffers(stream);
    grid->setTransform(entry.transform);
    return grid;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, {reader_.file()}, what);
  }

 private:
  VdbGrid readEntry() {
    VdbGrid entry;
    entry.descriptor = readVdbDescriptor(reader_, header_);
    entry.compression = reader_.value<std::uint32_t>("compression");
    entry.metadata = readVdbMetadata(reader_);
    ByteReader ahead = reader_;
    ahead.text("type of transform");
    MemoryStream stream(reader_);
    prepare(stream, entry.compression);
    entry.transform = openvdb::math::Transform::createLinearTransform();
    entry.transform->read(stream);
    reader_.take(static_cast<std::uint64_t>(stream.tellg()), "transform");
    entry.tree = reader_.position();
    return entry;
  }

  void prepare(std::istream& stream, std::uint32_t compression) const {
    openvdb::io::setVersion(stream, openvdb::VersionId(header_.library_major, header_.library_minor),
                            header_.file_version);
    openvdb::io::setDataCompression(stream, compression);
  }

  void walkTree(const VdbGrid& entry) {
    const std::optional<VdbVoxel> voxel = vdbVoxelOf(entry.descriptor.type);
    if (!voxel) {
      fail("grid " + entry.descriptor.name + " is of type " + entry.descriptor.type +
           "; float, double, int32 and int64 grids can be read");
    }
    walkVdbTree(reader_, *voxel, entry.descriptor.half, entry.compression);
  }

  const VdbGrid& ownerOfTree(const VdbGrid& entry) const {
    const std::string& parent = entry.descriptor.instance_parent;
    if (parent.empty()) return entry;
    for (const VdbGrid& other : entries_) {
      if (other.descriptor.unique_name == parent && other.descriptor.instance_parent.empty()) return other;
    }
    fail("grid " + entry.descriptor.name + " shares the tree of a grid that is not in the file");
  }

  std::vector<std::uint8_t> bytes_;
  ByteReader reader_;
  VdbHeader header_;
  std::vector<VdbGrid> entries_;
};

/// Beginning of errors about a grid.
std::string gridPrefix(const VdbGrid& entry) {
  return "grid " + entry.descriptor.name + ": ";
}

/// Why our metadata do not describe the grid, for warnOfCopiedMetadata(); null if they do, or there are none.
const char* whyCopied(const VdbGrid& entry) {
  const auto quantity = metaText(entry.metadata, "emscape:quantity");
  if (quantity && *quantity != entry.descriptor.own_name)
    return "it has another name than the quantity in its metadata";
  const auto spacing_m = metaDoubles(entry.metadata, "emscape:spacing_m");
  if (!spacing_m) return nullptr;  // written by version 0.2.0 or earlier
  const openvdb::Vec3d ratio =
      entry.transform->voxelSize() / openvdb::Vec3d(spacing_m->x, spacing_m->y, spacing_m->z);
  const bool agrees = ratio.eq(openvdb::Vec3d(1), 1e-6);
  return agrees ? nullptr : "its voxels have another spacing than in its metadata";
}

/// The name and nothing else.
DenseVolume foreignVolume(const VdbGrid& entry) {
  DenseVolume volume;
  volume.info.quantity = entry.descriptor.name.empty() ? kUnnamedGrid : entry.descriptor.name;
  volume.info.has_time = false;
  return volume;
}

/// The metadata; a file of another program leaves dims 0 and most other values at their defaults.
DenseVolume volumeOf(const VdbGrid& entry) {
  const VdbMetadata& metadata = entry.metadata;
  const auto text = [&](const char* key) { return metaText(metadata, std::string("emscape:") + key); };
  const auto number = [&](const char* key) { return metaNumber(metadata, std::string("emscape:") + key); };
  const auto floatOf = [&](const char* key) {
    return requireFloat(number(key).value_or(0), gridPrefix(entry) + "emscape:" + key);
  };
  DenseVolume volume = foreignVolume(entry);
  VolumeInfo& info = volume.info;
  info.unit = text("unit").value_or("");
  const std::optional<double> time_s = number("time_s");
  info.time_s = time_s.value_or(0);
  info.has_time = time_s.has_value();
  info.time_utc = text("time_utc").value_or("");
  info.floor = floatOf("floor");
  info.range_min = floatOf("range_min");
  info.range_max = floatOf("range_max");
  info.categorical = number("categorical").value_or(0) != 0;
  std::set<std::string> own_keys = {"emscape:quantity", "emscape:unit", "emscape:time_utc", "emscape:frame"};
  for (const auto& [key, value] : standardWords(true, {})) own_keys.insert("emscape:" + key);
  for (const auto& [key, value] : metadata) {
    const bool own = own_keys.count(key) > 0;
    if (key.rfind("emscape:", 0) == 0 && value.type == "string" && !own)
      info.extra[key.substr(8)] = value.bytes;
  }
  if (const auto dims = metaInts(metadata, "emscape:dims")) {
    volume.grid.dims = {dims->x, dims->y, dims->z};
    checkDims(volume.grid.dims, {}, gridPrefix(entry));
    // Both values must agree, so that a damaged one does not cause an allocation.
    if (number("voxel_count") != static_cast<double>(volume.grid.dims.count())) {
      throw Error(ErrorCode::bad_input,
                  gridPrefix(entry) + "emscape:voxel_count is not the product of emscape:dims");
    }
  }
  const auto frame = text("frame");
  const auto latitude_deg = number("origin_latitude_deg"), longitude_deg = number("origin_longitude_deg"),
             height_msl_m = number("origin_height_msl_m");
  if (frame && latitude_deg && longitude_deg && height_msl_m) {
    volume.grid.georeferenced = true;
    volume.grid.frame.kind = *frame == toString(FrameKind::enu) ? FrameKind::enu : FrameKind::altitude;
    volume.grid.frame.latitude_deg = *latitude_deg;
    volume.grid.frame.longitude_deg = *longitude_deg;
    volume.grid.frame.height_msl_m = *height_msl_m;
  }
  return volume;
}

/// Sets the volume's grid from the transform's scale and the centre of the voxel `first`.
/// @throws Error (bad_input) without a location if its axes are not x, y and z
void placeGrid(DenseVolume& volume, const VdbGrid& entry, const openvdb::math::Transform& transform,
               const openvdb::Coord& first, const VdbFile& file) {
  const std::string who = gridPrefix(entry);
  if (!transform.isLinear()) file.fail(who + "its transform is not linear");
  const openvdb::Vec3d spacing = transform.voxelSize();
  const openvdb::Vec3d center = transform.indexToWorld(first);
  volume.grid.spacing_m = {spacing.x(), spacing.y(), spacing.z()};
  volume.grid.first_center_m = {center.x(), center.y(), center.z()};
  checkGrid(volume.grid, who, {});
  std::array<double, 9> matrix{};
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d step(0);
    step[axis] = 1;
    const openvdb::Vec3d moved = transform.baseMap()->applyJacobian(step);
    for (int row = 0; row < 3; ++row) matrix[static_cast<std::size_t>(3 * row + axis)] = moved[row];
  }
  checkAxes(matrix, volume.grid.spacing_m, who, {});
}

bool isOurs(const DenseVolume& description) {
  return description.grid.dims.count() > 0;
}

void readMask(DenseVolume& volume, const VdbGrid& entry, const VdbFile& file) {
  const auto found = entry.metadata.find("emscape:first_valid_k");
  if (found == entry.metadata.end()) return;
  const std::string& bytes = found->second.bytes;
  if (bytes.size() % sizeof(std::uint16_t) != 0)
    file.fail(gridPrefix(entry) + "emscape:first_valid_k has an odd number of bytes");
  volume.first_valid_k.resize(bytes.size() / sizeof(std::uint16_t));
  std::memcpy(volume.first_valid_k.data(), bytes.data(), bytes.size());
}

openvdb::CoordBBox boxOf(const Dims& dims) {
  return {openvdb::Coord(0, 0, 0), openvdb::Coord(dims.x - 1, dims.y - 1, dims.z - 1)};
}

/// A volume without values and mask.
struct VdbDescription {
  explicit VdbDescription(const VdbGrid& entry)
      : why_copied(whyCopied(entry)),
        volume(why_copied == nullptr ? volumeOf(entry) : foreignVolume(entry)) {}

  const char* why_copied;  ///< as whyCopied(), and known better when the voxels have been read
  DenseVolume volume;
};

/// The values of `box` into a volume whose grid and info are set.
template <class GridType>
void copyValues(const GridType& grid, const openvdb::CoordBBox& box, DenseVolume& volume) {
  requireDenseMemory(volume.grid.dims, {});
  volume.values.resize(static_cast<std::size_t>(volume.grid.dims.count()));
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, volume.values.data());
  openvdb::tools::copyToDense(grid.tree(), dense);
}

template <class GridType>
bool makeDense(const openvdb::GridBase& base, const VdbGrid& entry, const VdbFile& file,
               VdbDescription& description) {
  const auto* grid = dynamic_cast<const GridType*>(&base);
  if (grid == nullptr) return false;
  const openvdb::CoordBBox active = grid->evalActiveVoxelBoundingBox();
  DenseVolume& volume = description.volume;
  if (isOurs(volume) && !active.empty() && !boxOf(volume.grid.dims).isInside(active)) {
    description.why_copied = "its active voxels are outside the dims in its metadata";
    volume = foreignVolume(entry);
  }
  const bool ours = isOurs(volume);
  if (!ours && active.empty())
    file.fail("grid " + entry.descriptor.name + " has no active voxels and does not say its dims");
  const openvdb::CoordBBox box = ours ? boxOf(volume.grid.dims) : active;
  if (!ours) {
    const openvdb::Coord size = active.dim();
    volume.grid.dims = {size.x(), size.y(), size.z()};
    volume.info.floor = static_cast<float>(grid->background());
    volume.info.categorical = std::is_integral_v<typename GridType::ValueType>;
    const auto& tree = grid->tree();
    checkSparseness(volume.grid.dims, tree.activeLeafVoxelCount() + tree.activeTileCount(), {});
  }
  placeGrid(volume, entry, grid->transform(), box.min(), file);
  copyValues(*grid, box, volume);
  if (ours) readMask(volume, entry, file);
  checkVolume(volume, {});
  if (!ours) setRangeFromValues(volume);
  return true;
}

/// Adds the file's name to all errors, OpenVDB's exceptions and exhausted memory included.
template <class Body>
auto withFileNamed(const std::filesystem::path& path, const Body& body) {
  try {
    return body();
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), {path.string()}, error.message());
  } catch (const std::exception& error) {
    if (isShortage(error)) throw Error(ErrorCode::other, {path.string()}, failureText(error));
    throw Error(ErrorCode::bad_input, {path.string()}, "OpenVDB cannot read it: " + failureText(error));
  }
}

/// The volume with its values.
void readGrid(VdbFile& file, const VdbGrid& entry, VdbDescription& description) {
  const openvdb::GridBase::Ptr grid = file.load(entry);
  makeDense<openvdb::FloatGrid>(*grid, entry, file, description) ||
      makeDense<openvdb::Int32Grid>(*grid, entry, file, description) ||
      makeDense<openvdb::DoubleGrid>(*grid, entry, file, description) ||
      makeDense<openvdb::Int64Grid>(*grid, entry, file, description);
}

}  // namespace

DenseVolume read(const std::filesystem::path& path, const std::string& grid_name) {
  return withFileNamed(path, [&] {
    VdbFile file(path);
    const auto volumeOfEntry = [&](const VdbGrid& entry) {
      VdbDescription description(entry);
      readGrid(file, entry, description);
      if (description.why_copied != nullptr)
        warnOfCopiedMetadata(path.string(), "grid " + entry.descriptor.name, description.why_copied);
      return std::move(description.volume);
    };
    if (!grid_name.empty()) return volumeOfEntry(file.find(grid_name));
    return std::move(readableOf(path.string(), file.entries(), 1, volumeOfEntry).front());
  });
}

std::vector<DenseVolume> describe(const std::filesystem::path& path) {
  return withFileNamed(path, [&] {
    VdbFile file(path);
    return readableOf(path.string(), file.entries(), file.entries().size(), [&](const VdbGrid& entry) {
      VdbDescription description(entry);
      DenseVolume& volume = description.volume;
      if (isOurs(volume)) {
        placeGrid(volume, entry, *entry.transform, openvdb::Coord(0, 0, 0), file);
        checkInfo(volume.info, gridPrefix(entry), {});
      } else {
        readGrid(file, entry, description);
        volume.values.clear();
        volume.values.shrink_to_fit();
      }
      return std::move(volume);
    });
  });
}

}  // namespace emscape::volume::vdb
