#include <algorithm>
#include <string>

#include "base/cuda/staged_copy.h"
#include "volume/cuda/device_storage.h"
#include "volume/sparse/sparse_grid.h"

namespace emscape::volume {
namespace {

using emscape::cuda::Buffer;
using emscape::cuda::check;
using emscape::cuda::checkLaunch;

/// Size (bytes) of the slabs of layers in which values are copied between host and device.
constexpr std::size_t kSlabBytes = std::size_t{64} << 20;
constexpr int kThreads = 128;
constexpr int kWarp = 32;

std::string mebibytes(std::size_t bytes) {
  return std::to_string((bytes + (std::size_t{1} << 20) - 1) >> 20) + " MiB";
}

std::string dimsText(const Dims& dims) {
  return std::to_string(dims.x) + " x " + std::to_string(dims.y) + " x " + std::to_string(dims.z);
}

void checkFits(const Dims& dims, VoxelPrecision precision) {
  checkDims(dims, {});
  if (precision == VoxelPrecision::sparse32) return;  // setSparse() allocates
  const bool half = precision == VoxelPrecision::float16;
  const std::string who =
      "GPU: a volume of " + dimsText(dims) + " voxels in " + (half ? "16" : "32") + " bit";
  constexpr int kMaxAlong = 16384;
  if (std::max({dims.x, dims.y, dims.z}) > kMaxAlong) {
    throw Error(ErrorCode::device, who + ": at most " + std::to_string(kMaxAlong) + " along each axis");
  }
  std::size_t free_bytes = 0, total_bytes = 0;
  check(cudaMemGetInfo(&free_bytes, &total_bytes), "cudaMemGetInfo");
  const std::size_t needed = deviceBytes(dims, precision);
  if (needed <= free_bytes) return;
  std::string message =
      who + " needs " + mebibytes(needed) + ", of which " + mebibytes(free_bytes) + " are free";
  if (!half) message += "; in 16 bit it would need " + mebibytes(deviceBytes(dims, VoxelPrecision::float16));
  throw Error(ErrorCode::device, message);
}

/// Layers begin_k .. end_k of each column, from the top down; the layer above end_k has already been written.
__global__ void storeSlab(const float* values, const std::int32_t* first_valid_k, VoxelWriter voxels,
                          int begin_k, int end_k) {
  const int columns = voxels.dims.x * voxels.dims.y;
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (column >= columns) return;
  const int i = column % voxels.dims.x;
  const int j = column / voxels.dims.x;
  const int first_valid = first_valid_k == nullptr ? 0 : first_valid_k[column];
  float above = end_k < voxels.dims.z ? voxels.read(i, j, end_k) : 0.0F;
  for (int k = end_k - 1; k >= begin_k; --k) {
    const float value = values[static_cast<long long>(k - begin_k) * columns + column];
    above = k < first_valid && k + 1 < voxels.dims.z ? above : value;
    voxels.write(i, j, k, above);
  }
}

/// Texels of a texture that does not filter.
struct PointTexels {
  cudaTextureObject_t texture;
  __device__ float at(int i, int j, int k) const {
    return tex3D<float>(texture, static_cast<float>(i) + 0.5F, static_cast<float>(j) + 0.5F,
                        static_cast<float>(k) + 0.5F);
  }
};

/// Converts a thread's voxels to the values that readers expect.
struct TexelSource {
  cudaTextureObject_t texture;
  __device__ PointTexels voxels() const { return {texture}; }
};
struct TileTexels {
  SparseTiles tiles;
  PointTexels texels;
  __device__ float at(int i, int j, int k) const {
    const SparseTile tile = tiles.at(i, j, k);
    if (tile.place == SparseTile::kNone) return tile.constant;
    return texels.at(SparseTiles::firstTexel(tile.place, 0) + SparseTiles::inBlock(i),
                     SparseTiles::firstTexel(tile.place, 1) + SparseTiles::inBlock(j),
                     SparseTiles::firstTexel(tile.place, 2) + SparseTiles::inBlock(k));
  }
};
struct SparseSource {
  const SparseTile* tiles;
  Dims dims;
  cudaTextureObject_t texture;
  __device__ TileTexels voxels() const { return {{tiles, dims}, {texture}}; }
};

__global__ void listBlocks(const void* grid, Dims block_dims, SparseBlock* blocks) {
  const long long block = static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (block >= block_dims.count()) return;
  const long long row = block / block_dims.x;
  blocks[block] = sparseBlockAt(grid, static_cast<int>(block % block_dims.x),
                                static_cast<int>(row % block_dims.y), static_cast<int>(row / block_dims.y));
}

/// Counts the blocks that need a tile, and numbers them in `place`.
__global__ void numberTiles(const SparseBlock* blocks, Dims block_dims, SparseTile* tiles,
                            std::uint32_t* count) {
  const long long index = static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (index >= block_dims.count()) return;
  const long long row = index / block_dims.x;
  const int x = static_cast<int>(index % block_dims.x), y = static_cast<int>(row % block_dims.y),
            z = static_cast<int>(row / block_dims.y);
  const float constant = blocks[index].constant;
  bool is_flat = true;
  for (int next = 0; next < 8; ++next) {
    const int i = min(x + (next & 1), block_dims.x - 1), j = min(y + (next >> 1 & 1), block_dims.y - 1),
              k = min(z + (next >> 2), block_dims.z - 1);
    const SparseBlock& block = blocks[(static_cast<long long>(k) * block_dims.y + j) * block_dims.x + i];
    is_flat = is_flat && block.values == nullptr && block.constant == constant;
  }
  tiles[index] = {is_flat ? SparseTile::kNone : static_cast<std::int32_t>(atomicAdd(count, 1U)), constant};
}

/// Sets the places of numbered tiles; each block of threads writes the texels of one.
__global__ void fillTiles(SparseVoxels voxels, Dims dims, Dims block_dims, Dims atlas_dims, SparseTile* tiles,
                          cudaSurfaceObject_t atlas) {
  constexpr int kTexels = SparseTiles::kTexels;
  const long long index = blockIdx.x;
  const std::int32_t number = tiles[index].place;
  if (number == SparseTile::kNone) return;
  const int row = number / atlas_dims.x;
  const std::int32_t place = number % atlas_dims.x | row % atlas_dims.y << 10 | row / atlas_dims.y << 20;
  const long long block_row = index / block_dims.x;
  const int first[3] = {static_cast<int>(index % block_dims.x) << SparseBlock::kEdgeBits,
                        static_cast<int>(block_row % block_dims.y) << SparseBlock::kEdgeBits,
                        static_cast<int>(block_row / block_dims.y) << SparseBlock::kEdgeBits};
  for (int texel = static_cast<int>(threadIdx.x); texel < kTexels * kTexels * kTexels;
       texel += static_cast<int>(blockDim.x)) {
    const int i = texel % kTexels, j = texel / kTexels % kTexels, k = texel / (kTexels * kTexels);
    const float value = voxels.at(min(first[0] + i, dims.x - 1), min(first[1] + j, dims.y - 1),
                                  min(first[2] + k, dims.z - 1));
    surf3Dwrite(value, atlas, (SparseTiles::firstTexel(place, 0) + i) * static_cast<int>(sizeof value),
                SparseTiles::firstTexel(place, 1) + j, SparseTiles::firstTexel(place, 2) + k);
  }
  __syncthreads();
  if (threadIdx.x == 0) tiles[index].place = place;
}

template <class Source>
__global__ void loadSlab(Source source, Dims dims, const std::int32_t* first_valid_k, float floor,
                         int begin_k, int end_k, float* values) {
  const int columns = dims.x * dims.y;
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (column >= columns) return;
  const auto voxels = source.voxels();
  const int i = column % dims.x;
  const int j = column / dims.x;
  const int first_valid = first_valid_k == nullptr ? 0 : first_valid_k[column];
  for (int k = begin_k; k < end_k; ++k) {
    values[static_cast<long long>(k - begin_k) * columns + column] =
        k < first_valid ? floor : voxels.at(i, j, k);
  }
}

__device__ float warpMin(float value) {
  for (int lanes = kWarp / 2; lanes > 0; lanes /= 2) {
    value = fminf(value, __shfl_xor_sync(~0U, value, lanes));
  }
  return value;
}

/// Each warp computes the range of one brick; see Bricks.
template <class Source>
__global__ void findBricks(Source source, Dims dims, Dims brick_dims, const std::int32_t* first_valid_k,
                           ValueRange* ranges) {
  const long long brick = (static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x) / kWarp;
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  if (brick >= brick_dims.count()) return;
  const auto voxels = source.voxels();
  const long long row = brick / brick_dims.x;
  const VoxelInterval x = withApron(static_cast<int>(brick % brick_dims.x), kBrickEdge, dims.x);
  const VoxelInterval y = withApron(static_cast<int>(row % brick_dims.y), kBrickEdge, dims.y);
  const VoxelInterval z = withApron(static_cast<int>(row / brick_dims.y), kBrickEdge, dims.z);
  const int width = x.end - x.begin;
  const int columns = width * (y.end - y.begin);
  float least = INFINITY, greatest = -INFINITY;
  bool masked = first_valid_k != nullptr;
  for (int column = lane; column < columns; column += kWarp) {
    const int i = x.begin + column % width;
    const int j = y.begin + column / width;
    if (masked) masked = z.end - 1 < first_valid_k[static_cast<long long>(j) * dims.x + i];
    for (int k = z.begin; k < z.end; ++k) {
      // NaN fails both comparisons
      const float value = voxels.at(i, j, k);
      least = value < least ? value : least;
      greatest = value > greatest ? value : greatest;
    }
  }
  const bool all_masked = __all_sync(~0U, masked) != 0;
  least = warpMin(least);
  greatest = -warpMin(-greatest);
  if (lane == 0) {
    ranges[brick] = all_masked ? ValueRange{INFINITY, -INFINITY} : ValueRange{least, greatest};
  }
}

unsigned blocksFor(long long threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

}  // namespace

DeviceStorage::DeviceStorage(const Dims& dims, VoxelPrecision precision)
    : dims_(dims), precision_(precision) {
  checkFits(dims, precision);
  try {
    allocate();
  } catch (...) {
    release();
    throw;
  }
}

DeviceStorage::~DeviceStorage() {
  release();
}

void DeviceStorage::allocate() {
  brick_dims_ = brickDims(dims_, kBrickEdge);
  bricks_.resize(static_cast<std::size_t>(brick_dims_.count()));
  if (precision_ == VoxelPrecision::float32) allocateTexels(cudaCreateChannelDesc<float>(), dims_);
  if (precision_ == VoxelPrecision::float16) allocateTexels(cudaCreateChannelDescHalf(), dims_);
}

void DeviceStorage::allocateTexels(const cudaChannelFormatDesc& format, const Dims& dims) {
  const cudaExtent extent = make_cudaExtent(
      static_cast<std::size_t>(dims.x), static_cast<std::size_t>(dims.y), static_cast<std::size_t>(dims.z));
  const std::string call = "cudaMalloc3DArray of " + dimsText(dims) + " voxels";
  check(cudaMalloc3DArray(&array_, &format, extent, cudaArraySurfaceLoadStore), call.c_str());
  cudaResourceDesc resource{};
  resource.resType = cudaResourceTypeArray;
  resource.res.array.array = array_;
  check(cudaCreateSurfaceObject(&surface_, &resource), "cudaCreateSurfaceObject");
  linear_ = makeTexture(cudaFilterModeLinear);
  point_ = makeTexture(cudaFilterModePoint);
}

cudaTextureObject_t DeviceStorage::makeTexture(cudaTextureFilterMode filter) const {
  cudaResourceDesc resource{};
  resource.resType = cudaResourceTypeArray;
  resource.res.array.array = array_;
  cudaTextureDesc description{};
  for (cudaTextureAddressMode& mode : description.addressMode) mode = cudaAddressModeClamp;
  description.filterMode = filter;
  description.readMode = cudaReadModeElementType;
  cudaTextureObject_t texture = 0;
  check(cudaCreateTextureObject(&texture, &resource, &description, nullptr), "cudaCreateTextureObject");
  return texture;
}

void DeviceStorage::release() {
  // Errors are ignored: the failure was reported before, or the device is lost. Freeing waits for readers.
  if (point_ != 0) cudaDestroyTextureObject(point_);
  if (linear_ != 0) cudaDestroyTextureObject(linear_);
  if (surface_ != 0) cudaDestroySurfaceObject(surface_);
  if (array_ != nullptr) cudaFreeArray(array_);
  point_ = linear_ = 0;
  surface_ = 0;
  array_ = nullptr;
}

/// Calls `use` with the accessor from which kernels read voxels.
template <class Use>
void DeviceStorage::withSource(const Use& use) const {
  if (precision_ == VoxelPrecision::sparse32) {
    use(SparseSource{sparse_tiles_.data(), dims_, point_});
  } else {
    use(TexelSource{point_});
  }
}

std::size_t DeviceStorage::sparseBytes() const {
  constexpr std::size_t kTileTexels = SparseTiles::kTexels * SparseTiles::kTexels * SparseTiles::kTexels;
  const std::size_t texels = static_cast<std::size_t>(atlas_dims_.count()) * kTileTexels;
  return texels * sizeof(float) + sparse_tiles_.size() * sizeof(SparseTile);
}

void DeviceStorage::setSparse(const std::uint8_t* grid, std::size_t bytes, cudaStream_t stream) {
  release();
  atlas_dims_ = {0, 0, 0};
  static_assert(1 << SparseBlock::kEdgeBits == kBrickEdge, "as many blocks as bricks");
  const auto requireFree = [&](std::size_t needed) {
    std::size_t free_bytes = 0, total_bytes = 0;
    check(cudaMemGetInfo(&free_bytes, &total_bytes), "cudaMemGetInfo");
    if (needed <= free_bytes) return;
    throw Error(ErrorCode::device, "GPU: a sparse volume of " + dimsText(dims_) + " voxels needs " +
                                       mebibytes(needed) + ", of which " + mebibytes(free_bytes) +
                                       " are free");
  };
  requireFree(bytes);
  Buffer<std::uint8_t> on_device;
  on_device.upload(grid, bytes, stream);
  Buffer<SparseBlock> blocks(bricks_.size());
  listBlocks<<<blocksFor(brick_dims_.count()), kThreads, 0, stream>>>(on_device.data(), brick_dims_,
                                                                      blocks.data());
  checkLaunch("listBlocks");
  sparse_tiles_.resize(bricks_.size());
  Buffer<std::uint32_t> counter(1);
  check(cudaMemsetAsync(counter.data(), 0, sizeof(std::uint32_t), stream), "cudaMemsetAsync");
  numberTiles<<<blocksFor(brick_dims_.count()), kThreads, 0, stream>>>(blocks.data(), brick_dims_,
                                                                       sparse_tiles_.data(), counter.data());
  checkLaunch("numberTiles");
  std::uint32_t count = 0;
  counter.download(&count, stream);
  if (count == 0) return;

  int across = 1;  // tiles along x and y of the atlas
  while (static_cast<long long>(across) * across * across < count) ++across;
  const long long layer = static_cast<long long>(across) * across;
  atlas_dims_ = {across, across, static_cast<int>((count + layer - 1) / layer)};
  requireFree(sparseBytes());
  constexpr int kTexels = SparseTiles::kTexels;
  allocateTexels(cudaCreateChannelDesc<float>(),
                 {atlas_dims_.x * kTexels, atlas_dims_.y * kTexels, atlas_dims_.z * kTexels});
  fillTiles<<<static_cast<unsigned>(brick_dims_.count()), kThreads, 0, stream>>>(
      SparseVoxels(blocks.data(), dims_), dims_, brick_dims_, atlas_dims_, sparse_tiles_.data(), surface_);
  checkLaunch("fillTiles");
  check(cudaStreamSynchronize(stream), "upload of a sparse volume");
}

VoxelWriter DeviceStorage::beginWriting(cudaStream_t stream) {
  const std::lock_guard<std::mutex> lock(order_);
  read_.holdBack(stream);
  written_.holdBack(stream);
  return voxels();
}

void DeviceStorage::endWriting(cudaStream_t stream) {
  withSource([&](const auto& source) {
    findBricks<<<blocksFor(brick_dims_.count() * kWarp), kThreads, 0, stream>>>(
        source, dims_, brick_dims_, firstValidK(), bricks_.data());
    checkLaunch("findBricks");
  });
  const std::lock_guard<std::mutex> lock(order_);
  written_.record(stream);
}

void DeviceStorage::beginReading(cudaStream_t stream) const {
  const std::lock_guard<std::mutex> lock(order_);
  written_.holdBack(stream);
}

void DeviceStorage::endReading(cudaStream_t stream) const {
  const std::lock_guard<std::mutex> lock(order_);
  // The event also covers the readers before this one.
  read_.holdBack(stream);
  read_.record(stream);
}

BricksView DeviceStorage::bricks() const {
  return {bricks_.data(), brick_dims_, kBrickEdge};
}

void DeviceStorage::setMask(const std::vector<std::uint16_t>& first_valid_k) {
  read_.wait();
  written_.wait();
  masked_below_ = 0;
  for (const std::uint16_t first_valid : first_valid_k)
    masked_below_ = std::max<int>(masked_below_, first_valid);
  if (masked_below_ == 0) return;
  first_valid_k_.resize(first_valid_k.size());
  const emscape::cuda::Stream stream;
  const auto widen = [&](char* to, std::size_t begin, std::size_t end) {
    constexpr std::size_t kSize = sizeof(std::int32_t);
    std::copy(first_valid_k.data() + begin / kSize, first_valid_k.data() + end / kSize,
              reinterpret_cast<std::int32_t*>(to));
  };
  emscape::cuda::uploadStaged(first_valid_k_.data(), first_valid_k.size() * sizeof(std::int32_t), widen,
                              stream);
  stream.wait();
}

int DeviceStorage::slabLayers() const {
  const std::size_t layer_bytes =
      sizeof(float) * static_cast<std::size_t>(dims_.x) * static_cast<std::size_t>(dims_.y);
  const std::size_t layers = std::max<std::size_t>(kSlabBytes / layer_bytes, 1);
  return static_cast<int>(std::min(layers, static_cast<std::size_t>(dims_.z)));
}

void DeviceStorage::writeFrom(const float* host_values, cudaStream_t stream) {
  const int layers = slabLayers();
  const long long columns = static_cast<long long>(dims_.x) * dims_.y;
  Buffer<float> slab(static_cast<std::size_t>(columns) * static_cast<std::size_t>(layers));
  for (int end_k = dims_.z; end_k > 0; end_k -= layers) {
    const int begin_k = std::max(end_k - layers, 0);
    check(cudaMemcpyAsync(slab.data(), host_values + columns * begin_k,
                          sizeof(float) * static_cast<std::size_t>(columns * (end_k - begin_k)),
                          cudaMemcpyHostToDevice, stream),
          "upload of a volume");
    storeSlab<<<blocksFor(columns), kThreads, 0, stream>>>(slab.data(), firstValidK(), voxels(), begin_k,
                                                           end_k);
    checkLaunch("storeSlab");
  }
  check(cudaStreamSynchronize(stream), "upload of a volume");  // before the slab is freed
}

/// Layers begin_k .. end_k - 1, in dense order, to device memory.
void DeviceStorage::loadLayers(int begin_k, int end_k, float floor, float* values,
                               cudaStream_t stream) const {
  withSource([&](const auto& source) {
    loadSlab<<<blocksFor(static_cast<long long>(dims_.x) * dims_.y), kThreads, 0, stream>>>(
        source, dims_, firstValidK(), floor, begin_k, end_k, values);
    checkLaunch("loadSlab");
  });
}

void DeviceStorage::copyTo(float* device_values, float floor, cudaStream_t stream) const {
  loadLayers(0, dims_.z, floor, device_values, stream);
}

void DeviceStorage::readTo(float* host_values, float floor, cudaStream_t stream) const {
  const int layers = slabLayers();
  const long long columns = static_cast<long long>(dims_.x) * dims_.y;
  Buffer<float> slab(static_cast<std::size_t>(columns) * static_cast<std::size_t>(layers));
  for (int begin_k = 0; begin_k < dims_.z; begin_k += layers) {
    const int end_k = std::min(begin_k + layers, dims_.z);
    loadLayers(begin_k, end_k, floor, slab.data(), stream);
    emscape::cuda::downloadStaged(host_values + columns * begin_k, slab.data(),
                                  sizeof(float) * static_cast<std::size_t>(columns * (end_k - begin_k)),
                                  stream);
  }
}

}  // namespace emscape::volume
