#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "render/cells/cell_order.h"
#include "render/cells/cuda/tile_projector.h"

namespace emscape::render {
namespace {

using emscape::cuda::check;
using emscape::cuda::checkLaunch;

constexpr int kThreads = 256;
constexpr int kTile = TileGrid::kTile;
static_assert(kTile * kTile == kThreads);

unsigned blocksFor(int count) {
  return static_cast<unsigned>((count + kThreads - 1) / kThreads);
}
__device__ int threadIndex() {
  return static_cast<int>(blockIdx.x * kThreads + threadIdx.x);
}

__global__ void viewPoints(const __grid_constant__ TileTask task, CellMeshView mesh, int count,
                           ViewPoint* points) {
  const int n = threadIndex();
  if (n < count) points[n] = task.viewOf(mesh.points[n], mesh.values[n]);
}

__global__ void findDepths(const __grid_constant__ TileTask task, CellMeshView mesh, int count, float* depths,
                           std::int32_t* cells) {
  const int n = threadIndex();
  if (n >= count) return;
  depths[n] = centroidDepth(mesh, task.camera, task.axes.depth, n);
  cells[n] = n;
}

/// @param order        the farthest first
/// @param tile_counts  receives the number of tiles that each cell touches, and 0 after the last one
__global__ void placeCells(const __grid_constant__ TileTask task, CellMeshView mesh, int count,
                           const std::int32_t* order, PlacedCell* cells, unsigned* tile_counts,
                           unsigned long long* drawn) {
  const int rank = threadIndex();
  unsigned touched = 0;
  if (rank < count) {
    cells[rank] = placed(task, mesh.vertices, order[count - 1 - rank]);
    TileGrid{task.camera.size}.eachTile(cells[rank].pixels, [&](int) { ++touched; });
  }
  if (rank <= count) tile_counts[rank] = touched;
  const int here = __syncthreads_count(touched > 0);
  if (threadIdx.x == 0) atomicAdd(drawn, static_cast<unsigned long long>(here));
}

__global__ void listTiles(const __grid_constant__ TileTask task, int count, const unsigned* before,
                          unsigned* tiles, int* ranks) {
  const int rank = threadIndex();
  if (rank >= count) return;
  unsigned place = before[rank];
  TileGrid{task.camera.size}.eachTile(task.cells[rank].pixels, [&](int tile) {
    tiles[place] = static_cast<unsigned>(tile);
    ranks[place++] = rank;
  });
}

/// @param first  receives the first of the sorted pairs of each tile, and one more
__global__ void findTiles(const unsigned* tiles, unsigned pairs, int count, unsigned* first) {
  const int tile = threadIndex();
  if (tile > count) return;
  unsigned low = 0, high = pairs;
  while (low < high) {
    const unsigned middle = low + (high - low) / 2;
    if (tiles[middle] < static_cast<unsigned>(tile)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  first[tile] = low;
}

/// One block per tile, one thread per pixel; a warp has 8 x 4 pixels.
__global__ void __launch_bounds__(kThreads)
    compositeTiles(const __grid_constant__ TileTask task, const int* ranks, const unsigned* first,
                   Rgba* picture) {
  constexpr int kBatch = 128;
  __shared__ __align__(16) unsigned char memory[kBatch * sizeof(TileCell)];
  TileCell* const batch = reinterpret_cast<TileCell*>(memory);

  const PixelBox tile = TileGrid{task.camera.size}.pixelsOf(static_cast<int>(blockIdx.x));
  const int warp = static_cast<int>(threadIdx.x / 32), lane = static_cast<int>(threadIdx.x % 32);
  const int x = tile.first_x + warp % 2 * 8 + lane % 8, y = tile.first_y + warp / 2 * 4 + lane / 8;
  const bool is_inside = x < tile.end_x && y < tile.end_y;
  const PixelRay ray(task, is_inside ? x : tile.first_x, is_inside ? y : tile.first_y);
  RayIntegral integral(task.transfer, task.psi);
  bool is_open = is_inside;
  const unsigned end = first[blockIdx.x + 1];
  for (unsigned begin = first[blockIdx.x]; begin < end; begin += kBatch) {
    const unsigned count = min(end - begin, static_cast<unsigned>(kBatch));
    if (__syncthreads_count(is_open) == 0) break;
    if (threadIdx.x < count) batch[threadIdx.x] = TileCell(task, ranks[begin + threadIdx.x]);
    __syncthreads();
    if (!is_open) continue;
    for (unsigned n = 0; n < count; ++n) {
      if (batch[n].pixels.holds(x, y)) addSegment(task, batch[n], ray, integral);
    }
    is_open = integral.through() >= task.through;
  }
  if (is_inside) picture[y * task.camera.size.width + x] = integral.color();
}

/// Calls a function of CUB: first for the size of its temporary memory, then with it.
template <class Call>
void withTemporary(emscape::cuda::Buffer<std::byte>& memory, const char* name, const Call& call) {
  std::size_t bytes = 0;
  check(call(nullptr, bytes), name);
  std::byte* const temporary = memory.atLeast(bytes);
  check(call(temporary, bytes), name);
}

}  // namespace

const std::int32_t* TileProjector::sorted(const TileTask& task, const MeshOnDevice& mesh,
                                          cudaStream_t stream) {
  const auto count = static_cast<std::size_t>(mesh.cells);
  for (auto* depths : {&depths_.from, &depths_.to}) depths->atLeast(count);
  for (auto* order : {&order_.from, &order_.to}) order->atLeast(count);
  findDepths<<<blocksFor(mesh.cells), kThreads, 0, stream>>>(task, mesh.view, mesh.cells, depths_.from.data(),
                                                             order_.from.data());
  checkLaunch("findDepths");
  withTemporary(temporary_, "cub::DeviceRadixSort of cells", [&](void* temporary, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairsDescending(temporary, bytes, depths_.from.data(), depths_.to.data(),
                                                     order_.from.data(), order_.to.data(), mesh.cells, 0, 32,
                                                     stream);
  });
  return order_.to.data();
}

const int* TileProjector::bin(const TileTask& task, const MeshOnDevice& mesh, cudaStream_t stream) {
  withTemporary(temporary_, "cub::DeviceScan", [&](void* temporary, std::size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(temporary, bytes, tile_counts_.from.data(), tile_counts_.to.data(),
                                         mesh.cells + 1, stream);
  });
  unsigned pairs = 0;
  check(cudaMemcpyAsync(&pairs, tile_counts_.to.data() + mesh.cells, sizeof pairs, cudaMemcpyDeviceToHost,
                        stream),
        "cudaMemcpyAsync from the GPU");
  check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
  for (auto* tiles : {&tiles_.from, &tiles_.to}) tiles->atLeast(pairs);
  for (auto* ranks : {&ranks_.from, &ranks_.to}) ranks->atLeast(pairs);
  listTiles<<<blocksFor(mesh.cells), kThreads, 0, stream>>>(task, mesh.cells, tile_counts_.to.data(),
                                                            tiles_.from.data(), ranks_.from.data());
  checkLaunch("listTiles");
  const int tiles = TileGrid{task.camera.size}.count();
  int bits = 1;
  while (tiles > 1 << bits) ++bits;
  withTemporary(temporary_, "cub::DeviceRadixSort of tiles", [&](void* temporary, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(temporary, bytes, tiles_.from.data(), tiles_.to.data(),
                                           ranks_.from.data(), ranks_.to.data(), pairs, 0, bits, stream);
  });
  first_.atLeast(static_cast<std::size_t>(tiles) + 1);
  findTiles<<<blocksFor(tiles + 1), kThreads, 0, stream>>>(tiles_.to.data(), pairs, tiles, first_.data());
  checkLaunch("findTiles");
  return ranks_.to.data();
}

TileTimes TileProjector::project(TileTask task, const MeshOnDevice& mesh,
                                 const std::vector<std::int32_t>* order, Image& image, cudaStream_t stream) {
  begin_.record(stream);
  const std::int32_t* const cells =
      order != nullptr ? order_.to.send(*order, stream) : sorted(task, mesh, stream);
  ordered_.record(stream);

  task.points = points_.atLeast(static_cast<std::size_t>(mesh.points));
  task.cells = cells_.atLeast(static_cast<std::size_t>(mesh.cells));
  viewPoints<<<blocksFor(mesh.points), kThreads, 0, stream>>>(task, mesh.view, mesh.points, points_.data());
  checkLaunch("viewPoints");
  tile_counts_.from.atLeast(static_cast<std::size_t>(mesh.cells) + 1);
  tile_counts_.to.atLeast(static_cast<std::size_t>(mesh.cells) + 1);
  drawn_.resize(1);
  check(cudaMemsetAsync(drawn_.data(), 0, sizeof(unsigned long long), stream), "cudaMemsetAsync");
  placeCells<<<blocksFor(mesh.cells + 1), kThreads, 0, stream>>>(
      task, mesh.view, mesh.cells, cells, cells_.data(), tile_counts_.from.data(), drawn_.data());
  checkLaunch("placeCells");
  const int* const ranks = bin(task, mesh, stream);
  binned_.record(stream);

  const ImageSize size = task.camera.size;
  picture_.resize(static_cast<std::size_t>(size.count()));
  compositeTiles<<<static_cast<unsigned>(TileGrid{size}.count()), kThreads, 0, stream>>>(
      task, ranks, first_.data(), picture_.data());
  checkLaunch("compositeTiles");
  drawn_mark_.record(stream);
  image = Image(size);
  picture_.download(image.pixels.data(), stream);
  unsigned long long drawn = 0;
  drawn_.download(&drawn, stream);
  return {ordered_.since_ms(begin_), binned_.since_ms(ordered_), drawn_mark_.since_ms(binned_),
          static_cast<long long>(drawn)};
}

}  // namespace emscape::render
