#include "volume/vdb/grid.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "emscape/base/parallel.h"

namespace emscape::volume::vdb {
namespace {

/// The voxels of one leaf, cut at the volume's edge.
struct Block {
  openvdb::Coord origin;
  int nx, ny, nz;
};

/// Fills trees leaf by leaf, in parallel.
template <class GridType>
class GridFiller {
 public:
  using Tree = typename GridType::TreeType;
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename GridType::ValueType;

  GridFiller(const DenseVolume& volume, const Value* values, Value floor)
      : volume_(volume), values_(values), floor_(floor) {}

  typename GridType::Ptr run() const {
    const Dims& dims = volume_.grid.dims;
    const Dims blocks{(dims.x + kEdge - 1) / kEdge, (dims.y + kEdge - 1) / kEdge,
                      (dims.z + kEdge - 1) / kEdge};
    std::vector<std::unique_ptr<Leaf>> leaves(static_cast<std::size_t>(blocks.count()));
    parallelFor(blocks.y * blocks.z, 4, [&](int begin, int end) {
      for (int row = begin; row < end; ++row) {
        for (int x = 0; x < blocks.x; ++x) {
          leaves[static_cast<std::size_t>(row) * blocks.x + x] =
              makeLeaf(blockAt(x, row % blocks.y, row / blocks.y));
        }
      }
    });
    // Created by the library, so that the virtual functions of grid and tree are not compiled here again.
    const auto grid = openvdb::gridPtrCast<GridType>(openvdb::GridBase::createGrid(GridType::gridType()));
    grid->tree().root().setBackground(floor_, /*updateChildNodes=*/false);
    for (std::unique_ptr<Leaf>& leaf : leaves) {
      if (!leaf) continue;
      if (isConstant(*leaf)) {
        grid->tree().addTile(1, leaf->origin(), leaf->getValue(0), true);
      } else {
        grid->tree().addLeaf(leaf.release());
      }
    }
    return grid;
  }

 private:
  static constexpr int kEdge = Leaf::DIM;

  Block blockAt(int x, int y, int z) const {
    const Dims& dims = volume_.grid.dims;
    const openvdb::Coord origin(x * kEdge, y * kEdge, z * kEdge);
    return {origin, std::min(kEdge, dims.x - origin.x()), std::min(kEdge, dims.y - origin.y()),
            std::min(kEdge, dims.z - origin.z())};
  }

  /// Null if no voxel of the block is active.
  std::unique_ptr<Leaf> makeLeaf(const Block& block) const {
    std::unique_ptr<Leaf> leaf;
    for (int k = 0; k < block.nz; ++k) {
      for (int j = 0; j < block.ny; ++j) {
        const int gj = block.origin.y() + j, gk = block.origin.z() + k;
        const Value* row = values_ + volume_.grid.index(block.origin.x(), gj, gk);
        for (int i = 0; i < block.nx; ++i) {
          if (row[i] == floor_ || volume_.isMasked(block.origin.x() + i, gj, gk)) continue;
          if (!leaf) leaf = std::make_unique<Leaf>(block.origin, floor_);
          leaf->setValueOn(Leaf::coordToOffset(openvdb::Coord(i, j, k)), row[i]);
        }
      }
    }
    return leaf;
  }

  /// True if all voxels are active with the same bits, so that a tile can replace the leaf.
  static bool isConstant(const Leaf& leaf) {
    if (!leaf.getValueMask().isOn()) return false;
    const Value* values = leaf.buffer().data();
    return std::all_of(values, values + Leaf::SIZE,
                       [&](const Value& value) { return std::memcmp(&value, values, sizeof(Value)) == 0; });
  }

  const DenseVolume& volume_;
  const Value* values_;
  Value floor_;
};

openvdb::math::Transform::Ptr transformOf(const Grid& grid) {
  // OpenVDB simplifies a transform made from one map, which changes the last bits of the spacing; it does not
  // simplify one that is composed.
  auto transform = openvdb::math::Transform::createLinearTransform();
  transform->preScale(openvdb::Vec3d(grid.spacing_m.x, grid.spacing_m.y, grid.spacing_m.z));
  transform->postTranslate(
      openvdb::Vec3d(grid.first_center_m.x, grid.first_center_m.y, grid.first_center_m.z));
  return transform;
}

void setMetadata(openvdb::GridBase& grid, const DenseVolume& volume) {
  const VolumeInfo& info = volume.info;
  const auto set = [&](const char* key, const openvdb::Metadata& value) {
    grid.insertMeta("emscape:" + std::string(key), value);
  };
  for (const auto& [key, value] : info.extra) set(key.c_str(), openvdb::StringMetadata(value));
  set("quantity", openvdb::StringMetadata(info.quantity));
  set("unit", openvdb::StringMetadata(info.unit));
  set("time_s", openvdb::DoubleMetadata(info.time_s));
  set("time_utc", openvdb::StringMetadata(info.time_utc));
  set("floor", openvdb::FloatMetadata(info.floor));
  set("range_min", openvdb::FloatMetadata(info.range_min));
  set("range_max", openvdb::FloatMetadata(info.range_max));
  set("categorical", openvdb::BoolMetadata(info.categorical));
  for (const auto& [key, text] : standardWords(volume.grid.georeferenced, volume.grid.frame))
    set(key.c_str(), openvdb::StringMetadata(text));
  const Dims& dims = volume.grid.dims;
  const Vec3d& spacing_m = volume.grid.spacing_m;
  set("spacing_m", openvdb::Vec3DMetadata(openvdb::Vec3d(spacing_m.x, spacing_m.y, spacing_m.z)));
  set("dims", openvdb::Vec3IMetadata(openvdb::Vec3i(dims.x, dims.y, dims.z)));
  set("voxel_count", openvdb::Int64Metadata(dims.count()));
  if (volume.grid.georeferenced) {
    const FrameOrigin& frame = volume.grid.frame;
    set("frame", openvdb::StringMetadata(toString(frame.kind)));
    set("origin_latitude_deg", openvdb::DoubleMetadata(frame.latitude_deg));
    set("origin_longitude_deg", openvdb::DoubleMetadata(frame.longitude_deg));
    set("origin_height_msl_m", openvdb::DoubleMetadata(frame.height_msl_m));
  }
  if (!volume.first_valid_k.empty()) {
    openvdb::UnknownMetadata mask("emscape_uint16");
    std::vector<std::uint8_t> bytes(volume.first_valid_k.size() * sizeof(std::uint16_t));
    std::memcpy(bytes.data(), volume.first_valid_k.data(), bytes.size());
    mask.setValue(bytes);
    set("first_valid_k", mask);
  }
}

}  // namespace

void initializeOpenVdb() {
  openvdb::initialize();
}

openvdb::GridBase::Ptr toOpenVdb(const DenseVolume& volume, const SourceLocation& location) {
  initializeOpenVdb();
  openvdb::GridBase::Ptr grid;
  if (volume.info.categorical) {
    const std::vector<std::int32_t> indices = toIndices(volume, location);
    grid =
        GridFiller<openvdb::Int32Grid>(volume, indices.data(), static_cast<std::int32_t>(volume.info.floor))
            .run();
  } else {
    grid = GridFiller<openvdb::FloatGrid>(volume, volume.values.data(), volume.info.floor).run();
  }
  grid->setName(volume.info.quantity);
  // A fog volume has floating-point values.
  grid->setGridClass(volume.info.categorical ? openvdb::GRID_UNKNOWN : openvdb::GRID_FOG_VOLUME);
  grid->setCreator("emscape " EMSCAPE_VERSION);
  grid->setTransform(transformOf(volume.grid));
  setMetadata(*grid, volume);
  return grid;
}

}  // namespace emscape::volume::vdb
