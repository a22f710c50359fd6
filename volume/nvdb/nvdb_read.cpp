#include <algorithm>
#include <array>

#include "base/files/file_reading.h"
#include "emscape/base/work.h"
#include "emscape/volume/statistics.h"
#include "volume/byte_reader.h"
#include "volume/description_check.h"
#include "volume/foreign.h"
#include "volume/nvdb/nvdb.h"
#include "volume/sparse/nanovdb_wrapper.h"
#include "volume/volume_json.h"

namespace emscape::volume {
namespace {

struct GridEntry {
  std::string name;
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// The `dims` voxels from `first` on, in dense order.
struct DenseBox {
  nano::Coord first;
  Dims dims;
  UnsetVector<float>& values;
};

/// A grid in memory. NanoVDB follows its offsets unchecked; here each is checked to point to a node inside
/// the grid first.
template <class Value>
class NanoGrid {
 public:
  using Root = typename nano::NanoRoot<Value>::DataType;
  using Upper = typename nano::NanoUpper<Value>::DataType;
  using Lower = typename nano::NanoLower<Value>::DataType;
  using Leaf = typename nano::NanoLeaf<Value>::DataType;

  /// @param bytes  aligned as NanoVDB needs
  NanoGrid(const std::uint8_t* bytes, std::uint64_t size, const ByteReader& file)
      : begin_(bytes), size_(size), file_(file), tree_(at<nano::TreeData>(bytes, sizeof(nano::GridData))) {
    root_ = at<Root>(tree_, static_cast<std::int64_t>(tree_->mNodeOffset[3]));
    const auto tiles_begin =
        static_cast<std::uint64_t>(reinterpret_cast<const std::uint8_t*>(root_ + 1) - begin_);
    if (root_->mTableSize > (size_ - tiles_begin) / sizeof(typename Root::Tile)) damaged();
  }

  float background() const { return static_cast<float>(root_->mBackground); }
  /// Upper bound of the number of active voxels and tiles with a value in the grid.
  std::uint64_t storedVoxels() const {
    const std::uint64_t tiles =
        std::uint64_t{tree_->mTileCount[0]} + tree_->mTileCount[1] + tree_->mTileCount[2];
    const std::uint64_t listed =
        std::uint64_t{tree_->mNodeCount[0]} * (kLeafEdge * kLeafEdge * kLeafEdge) + tiles;
    return std::min({listed, std::uint64_t{tree_->mVoxelCount}, size_ / sizeof(Value)});
  }
  nano::Coord firstActive() const { return root_->mBBox[0]; }
  nano::Coord lastActive() const { return root_->mBBox[1]; }

  void copyTo(DenseBox& box) {
    std::fill(box.values.begin(), box.values.end(), background());
    for (std::uint32_t i = 0; i < root_->mTableSize; ++i) {
      const typename Root::Tile* tile = root_->tile(i);
      const nano::Coord origin = tile->origin();
      if (!tile->isChild()) {
        fill(box, origin, kUpperEdge, tile->value);
        continue;
      }
      countNode(sizeof(Upper));
      copyInternal(*at<Upper>(root_, tile->child), origin, kUpperEdge, box);
    }
  }

 private:
  static constexpr int kLeafEdge = 8, kLowerEdge = 128, kUpperEdge = 4096;

  [[noreturn]] void damaged() const { file_.fail("a node of the tree is outside the grid"); }

  template <class Node>
  const Node* at(const void* base, std::int64_t offset) const {
    const auto from = static_cast<std::int64_t>(static_cast<const std::uint8_t*>(base) - begin_);
    const auto limit = static_cast<std::int64_t>(size_);
    if (offset > limit || offset < -limit) damaged();
    const std::int64_t position = from + offset;
    if (position < 0 || limit < static_cast<std::int64_t>(sizeof(Node)) ||
        position > limit - static_cast<std::int64_t>(sizeof(Node)) ||
        position % static_cast<std::int64_t>(nano::kAlignment) != 0) {
      damaged();
    }
    return reinterpret_cast<const Node*>(begin_ + position);
  }

  /// More nodes than fit into the grid: some are visited twice.
  void countNode(std::uint64_t bytes) {
    visited_bytes_ += bytes;
    if (visited_bytes_ > size_) file_.fail("nodes of the tree overlap");
  }

  template <class Node>
  void copyInternal(const Node& node, const nano::Coord& origin, int edge, DenseBox& box) {
    constexpr bool kAboveLeaves = std::is_same_v<Node, Lower>;
    constexpr int kLog2 = kAboveLeaves ? 4 : 5;
    const int child_edge = edge >> kLog2;
    for (std::uint32_t n = 0; n < 1U << (3 * kLog2); ++n) {
      const nano::Coord local(static_cast<int>(n >> (2 * kLog2)),
                              static_cast<int>(n >> kLog2) & ((1 << kLog2) - 1),
                              static_cast<int>(n) & ((1 << kLog2) - 1));
      const nano::Coord place = shifted(origin, local, child_edge);
      if (!node.mChildMask.isOn(n)) {
        fill(box, place, child_edge, node.mTable[n].value);
      } else if constexpr (kAboveLeaves) {
        countNode(sizeof(Leaf));
        copyLeaf(*at<Leaf>(&node, node.mTable[n].child), place, box);
      } else {
        countNode(sizeof(Lower));
        copyInternal(*at<Lower>(&node, node.mTable[n].child), place, child_edge, box);
      }
    }
  }

  /// Wraps around instead of overflowing on a damaged key.
  static nano::Coord shifted(const nano::Coord& origin, const nano::Coord& local, int edge) {
    const auto sum = [&](int axis) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(origin[axis]) +
                                       static_cast<std::uint32_t>(local[axis] * edge));
    };
    return {sum(0), sum(1), sum(2)};
  }

  struct Interval {
    int begin = 0, end = 0;  ///< voxels of the box
  };

  /// The part of a node along one axis inside the box.
  static Interval overlap(int node, int edge, int first, int count) {
    const long long begin = static_cast<long long>(node) - first;
    return {static_cast<int>(std::clamp<long long>(begin, 0, count)),
            static_cast<int>(std::clamp<long long>(begin + edge, 0, count))};
  }

  template <class Put>
  static void forRows(DenseBox& box, const nano::Coord& origin, int edge, const Put& put) {
    const Interval x = overlap(origin[0], edge, box.first[0], box.dims.x);
    const Interval y = overlap(origin[1], edge, box.first[1], box.dims.y);
    const Interval z = overlap(origin[2], edge, box.first[2], box.dims.z);
    if (x.begin == x.end) return;
    checkpoint();
    for (int k = z.begin; k < z.end; ++k) {
      for (int j = y.begin; j < y.end; ++j) {
        float* row = box.values.data() + (static_cast<std::size_t>(k) * box.dims.y + j) * box.dims.x;
        put(row, x, j, k);
      }
    }
  }

  void fill(DenseBox& box, const nano::Coord& origin, int edge, Value value) const {
    if (std::memcmp(&value, &root_->mBackground, sizeof(Value)) == 0) return;
    forRows(box, origin, edge, [&](float* row, Interval x, int, int) {
      std::fill(row + x.begin, row + x.end, static_cast<float>(value));
    });
  }

  void copyLeaf(const Leaf& leaf, const nano::Coord& origin, DenseBox& box) const {
    forRows(box, origin, kLeafEdge, [&](float* row, Interval x, int j, int k) {
      const int ly = j + box.first[1] - origin[1], lz = k + box.first[2] - origin[2];
      for (int i = x.begin; i < x.end; ++i) {
        const int lx = i + box.first[0] - origin[0];
        row[i] = static_cast<float>(leaf.mValues[lx * kLeafEdge * kLeafEdge + ly * kLeafEdge + lz]);
      }
    });
  }

  const std::uint8_t* begin_;
  std::uint64_t size_;
  const ByteReader& file_;
  const nano::TreeData* tree_;
  const Root* root_ = nullptr;
  std::uint64_t visited_bytes_ = 0;
};

class NvdbFile {
 public:
  explicit NvdbFile(const std::filesystem::path& path)
      : path_(path), bytes_(readWhole(path)), reader_(path.string(), bytes_.data(), bytes_.size()) {
    do {
      readSegment();
    } while (reader_.left() > 0);
    readSidecar();
  }

  const std::vector<GridEntry>& entries() const { return entries_; }

  const GridEntry& find(const std::string& name) const {
    std::vector<std::string> names;
    for (const GridEntry& entry : entries_) names.push_back(entry.name);
    return entries_[indexOfName(names, name, kUnnamedGrid, "grid", path_.string())];
  }

  /// The sidecar's description of a grid; dims 0 if there is none.
  DenseVolume description(const GridEntry& entry) const {
    const auto found = std::find_if(sidecar_.begin(), sidecar_.end(), [&](const DenseVolume& volume) {
      return volume.info.quantity == entry.name;
    });
    return found == sidecar_.end() ? DenseVolume() : *found;
  }

  DenseVolume read(const GridEntry& entry) const {
    if (entry.size < sizeof(nano::GridData)) reader_.fail("a grid without its header");
    nano::Buffer buffer = nano::Buffer::create(entry.size);
    std::memcpy(buffer.data(), bytes_.data() + entry.offset, entry.size);
    const auto* data = reinterpret_cast<const nano::GridData*>(buffer.data());
    if (data->mMagic != nano::kMagic) reader_.fail("a grid without its header");
    switch (data->mGridType) {
      case nano::GridType::Float:
        return readAs<float>(entry, *data, false);
      case nano::GridType::Double:
        return readAs<double>(entry, *data, false);
      case nano::GridType::Int32:
        return readAs<std::int32_t>(entry, *data, true);
      case nano::GridType::Int64:
        return readAs<std::int64_t>(entry, *data, true);
      default:
        break;
    }
    fail("grid " + entry.name + " is of NanoVDB's type " +
         std::to_string(static_cast<std::uint32_t>(data->mGridType)) +
         "; float, double, int32 and int64 grids can be read");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, {path_.string()}, what);
  }

 private:
  /// A header, the descriptions of some grids, and those grids.
  void readSegment() {
    const auto magic =
        reader_.left() < sizeof(std::uint64_t) ? 0 : reader_.value<std::uint64_t>("magic number");
    if (magic != nano::kMagic) fail("no NanoVDB file of this byte order");
    const auto major = reader_.value<std::uint32_t>("version") >> 21;
    if (major != static_cast<std::uint32_t>(nano::kMajorVersion)) {
      fail("NanoVDB file of version " + std::to_string(major) + "; version " +
           std::to_string(nano::kMajorVersion) + " can be read");
    }
    const auto grids = reader_.value<std::uint16_t>("number of grids");
    const auto codec = reader_.value<std::uint16_t>("codec");
    if (codec != static_cast<std::uint16_t>(nano::FileCodec::NONE)) {
      fail("compressed with NanoVDB's codec " + std::to_string(codec) +
           "; files without compression can be read");
    }
    if (grids == 0) reader_.fail("a segment without grids");
    const std::size_t first = entries_.size();
    for (int i = 0; i < grids; ++i) {
      const auto meta = reader_.value<nano::FileMetaData>("description of a grid");
      const std::uint8_t* name = reader_.take(meta.nameSize, "name of a grid");
      const std::uint8_t* name_end = std::find(name, name + meta.nameSize, std::uint8_t(0));
      if (meta.fileSize != meta.gridSize) reader_.fail("a grid of two sizes");
      entries_.push_back({std::string(name, name_end), 0, meta.gridSize});
    }
    for (std::size_t i = first; i < entries_.size(); ++i) {
      entries_[i].offset = reader_.position();
      reader_.take(entries_[i].size, "grid");
    }
  }

  void readSidecar() {
    const std::filesystem::path path = sidecarOf(path_);
    std::error_code ignored;  // its name may be too long
    if (!std::filesystem::exists(path, ignored)) return;
    const std::vector<std::uint8_t> text = readWhole(path);
    const auto json = parseJson({text.begin(), text.end()}, path.string());
    for (const auto& volume : requiredFromJson<nlohmann::ordered_json>(json, "volumes", path.string())) {
      requiredFromJson<double>(volume, "voxels", path.string());  // compared with the dims by fromJson()
      sidecar_.push_back(fromJson(volume, path.string()));
    }
  }

  template <class Value>
  DenseVolume readAs(const GridEntry& entry, const nano::GridData& data, bool categorical) const {
    NanoGrid<Value> grid(reinterpret_cast<const std::uint8_t*>(&data), entry.size, reader_);
    DenseVolume volume = description(entry);
    const bool ours = volume.grid.dims.count() > 0;
    nano::Coord first(0, 0, 0);
    if (!ours) {
      first = grid.firstActive();
      volume.info.quantity = entry.name.empty() ? kUnnamedGrid : entry.name;
      volume.info.has_time = false;
      volume.info.floor = grid.background();
      volume.info.categorical = categorical;
      placeForeign(volume, data, first, grid.lastActive());
      checkSparseness(volume.grid.dims, grid.storedVoxels(), {path_.string()});
    }
    requireDenseMemory(volume.grid.dims, {path_.string()});
    volume.values.resize(static_cast<std::size_t>(volume.grid.dims.count()));
    DenseBox box{first, volume.grid.dims, volume.values};
    grid.copyTo(box);
    checkVolume(volume, {path_.string()});
    if (!ours) setRangeFromValues(volume);
    return volume;
  }

  void placeForeign(DenseVolume& volume, const nano::GridData& data, const nano::Coord& first,
                    const nano::Coord& last) const {
    const std::string who = "grid " + volume.info.quantity + ": ";
    Grid& grid = volume.grid;
    int counts[3];
    for (int axis = 0; axis < 3; ++axis) {
      const long long count = static_cast<long long>(last[axis]) - first[axis] + 1;
      counts[axis] = static_cast<int>(std::clamp<long long>(count, 0, INT32_MAX));
    }
    grid.dims = {counts[0], counts[1], counts[2]};
    if (grid.dims.count() == 0) fail(who + "it has no active voxels");
    const nano::Vec3d center = data.applyMap(nano::Vec3d(first[0], first[1], first[2]));
    grid.first_center_m = {center[0], center[1], center[2]};
    grid.spacing_m = {data.mVoxelSize[0], data.mVoxelSize[1], data.mVoxelSize[2]};
    checkGrid(grid, who, {path_.string()});
    std::array<double, 9> matrix{};
    std::copy(std::begin(data.mMap.mMatD), std::end(data.mMap.mMatD), matrix.begin());
    checkAxes(matrix, grid.spacing_m, who, {path_.string()});
  }

  std::filesystem::path path_;
  std::vector<std::uint8_t> bytes_;
  ByteReader reader_;
  std::vector<GridEntry> entries_;
  std::vector<DenseVolume> sidecar_;
};

}  // namespace

DenseVolume readNvdb(const std::filesystem::path& path, const std::string& grid_name) {
  const NvdbFile file(path);
  if (!grid_name.empty()) return file.read(file.find(grid_name));
  std::vector<DenseVolume> volumes =
      readableOf(path.string(), file.entries(), 1, [&](const GridEntry& entry) { return file.read(entry); });
  return std::move(volumes.front());
}

std::vector<DenseVolume> describeNvdb(const std::filesystem::path& path) {
  const NvdbFile file(path);
  return readableOf(path.string(), file.entries(), file.entries().size(), [&](const GridEntry& entry) {
    DenseVolume volume = file.description(entry);
    if (volume.grid.dims.count() == 0) volume = file.read(entry);
    volume.values = {};
    volume.first_valid_k = {};
    return volume;
  });
}

}  // namespace emscape::volume
