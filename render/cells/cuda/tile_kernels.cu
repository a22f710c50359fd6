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

/// @param behind  receives facesBehind(); null: not needed
__global__ void findKeys(const __grid_constant__ TileTask task, CellMeshView mesh, int count,
                         std::uint32_t* keys, std::int32_t* cells, std::uint8_t* behind) {
  const int n = threadIndex();
  if (n >= count) return;
  keys[n] = centroidKey(mesh, task.camera, task.axes.depth, n);
  cells[n] = n;
  if (behind != nullptr) behind[n] = facesBehind(mesh, task.camera, n);
}

/// Raises the keys of hidden neighbours that do not exceed the cell's own.
/// @param raised  receives their number; null: not needed
__global__ void raiseNeighbours(CellMeshView mesh, int count, const std::uint8_t* behind, std::uint32_t* keys,
                                unsigned* raised) {
  const int cell = threadIndex();
  unsigned here = 0;
  if (cell < count) {
    const unsigned faces = behind[cell];
    const std::uint32_t key = keys[cell];
    for (int face = 0; face < 4; ++face) {
      if ((faces >> face & 1) == 0) continue;
      std::uint32_t* const neighbour = keys + mesh.other_side[4 * cell + face] / 4;
      if (*neighbour > key) continue;
      atomicMax(neighbour, key + 1);
      ++here;
    }
  }
  if (raised != nullptr && here > 0) atomicAdd(raised, here);
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

/// Pixels whose rays met cells in the wrong order.
struct WrongPixels {
  unsigned* count;
  int* pixels;
};

/// One block per tile, one thread per pixel; a warp has 8 x 4 pixels.
/// @param kFindsWrong  also lists the pixels whose rays meet cells in the wrong order. All cells are then
/// checked, also those behind opaque ones
template <bool kFindsWrong>
__global__ void __launch_bounds__(kThreads)
    compositeTiles(const __grid_constant__ TileTask task, const int* ranks, const unsigned* first,
                   WrongPixels wrong, Rgba* picture) {
  constexpr unsigned kBatch = 128, kGroup = 64;
  __shared__ __align__(16) unsigned char memory[kBatch * sizeof(TileCell)];
  TileCell* const batch = reinterpret_cast<TileCell*>(memory);

  const PixelBox tile = TileGrid{task.camera.size}.pixelsOf(static_cast<int>(blockIdx.x));
  const int warp = static_cast<int>(threadIdx.x / 32), lane = static_cast<int>(threadIdx.x % 32);
  const int first_x = tile.first_x + warp % 2 * 8, first_y = tile.first_y + warp / 2 * 4;
  const PixelBox pixels{first_x, first_y, first_x + 8, first_y + 4};  // of the warp
  const int x = first_x + lane % 8, y = first_y + lane / 8;
  const bool is_inside = x < tile.end_x && y < tile.end_y;
  const PixelRay ray(task, is_inside ? x : tile.first_x, is_inside ? y : tile.first_y);
  RayIntegral integral(task.transfer, task.psi);
  bool is_searched = is_inside, is_wrong = false;
  double last = 0;  // middle of the last segment
  const unsigned end = first[blockIdx.x + 1];
  for (unsigned begin = first[blockIdx.x]; begin < end; begin += kBatch) {
    const unsigned count = min(end - begin, kBatch);
    if (__syncthreads_count(is_searched) == 0) break;
    if (threadIdx.x < count) batch[threadIdx.x] = TileCell(task, ranks[begin + threadIdx.x]);
    __syncthreads();
    if (!__any_sync(0xffffffffu, is_searched)) continue;
    // First each ray finds the cells that it meets, then it integrates: these are others for each lane, so
    // that few lanes wait.
    for (unsigned n = 0; n < count; n += kGroup) {
      unsigned long long met = 0;
      for (unsigned m = 0; m < kGroup; m += 32) {
        const unsigned mine = n + m + lane;
        const bool is_near = mine < count && !common(batch[mine].pixels, pixels).isEmpty();
        for (unsigned near = __ballot_sync(0xffffffffu, is_near); near != 0; near &= near - 1) {
          const int bit = static_cast<int>(m) + __ffs(static_cast<int>(near)) - 1;
          const TileCell& cell = batch[n + bit];
          RaySegment segment;
          if (is_searched && cell.pixels.holds(x, y) && cell.meets(ray, task.camera.orthographic, segment))
            met |= 1ull << bit;
        }
      }
      for (; met != 0; met &= met - 1) {
        const TileCell& cell = batch[n + __ffsll(static_cast<long long>(met)) - 1];
        if constexpr (kFindsWrong) {
          RaySegment segment;
          cell.meets(ray, task.camera.orthographic, segment);
          is_wrong = is_wrong || segment.middle() < last;
          if (integral.through() < task.through) continue;
          last = segment.middle();
          addSegment(segment, ray, integral);
        } else {
          addSegment(task, cell, ray, integral);
        }
      }
    }
    if (!kFindsWrong) is_searched = is_searched && integral.through() >= task.through;
  }
  if (!is_inside) return;
  const int pixel = y * task.camera.size.width + x;
  picture[pixel] = integral.color();
  if (is_wrong) wrong.pixels[atomicAdd(wrong.count, 1u)] = pixel;
}

/// Composites rays again with their segments sorted: up to kThreads of them at a time, the nearest first. One
/// block per pixel.
__global__ void __launch_bounds__(kThreads)
    compositeSorted(const __grid_constant__ TileTask task, const int* ranks, const unsigned* first,
                    const int* pixels, Rgba* picture) {
  __shared__ __align__(16) unsigned char memory[kThreads * sizeof(RaySegment)];
  RaySegment* const segments = reinterpret_cast<RaySegment*>(memory);
  __shared__ int order[kThreads];
  __shared__ unsigned count;
  __shared__ unsigned long long nearest,
      farthest;  // middles; as integers in the same order, as none is negative
  __shared__ bool is_done;

  const int pixel = pixels[blockIdx.x], width = task.camera.size.width;
  const int x = pixel % width, y = pixel / width, thread = static_cast<int>(threadIdx.x);
  const int tile = TileGrid{task.camera.size}.tileOf(x, y);
  const PixelRay ray(task, x, y);
  RayIntegral integral(task.transfer, task.psi);  // of the first thread
  double behind = -1, limit = HUGE_VAL;           // middles of the segments that are sorted: ]behind, limit]
  do {
    if (thread == 0) {
      count = 0;
      nearest = ~0ull;
      farthest = 0;
    }
    __syncthreads();
    for (unsigned n = first[tile] + threadIdx.x; n < first[tile + 1]; n += kThreads) {
      RaySegment segment;
      if (!task.cells[ranks[n]].pixels.holds(x, y) ||
          !TileCell(task, ranks[n]).meets(ray, task.camera.orthographic, segment))
        continue;
      const double middle = segment.middle();
      if (!(middle > behind && middle <= limit)) continue;
      const auto at = static_cast<unsigned long long>(__double_as_longlong(middle));
      atomicMin(&nearest, at);
      atomicMax(&farthest, at);
      const unsigned place = atomicAdd(&count, 1u);
      if (place < kThreads) segments[place] = segment;
    }
    __syncthreads();
    const unsigned found = count;
    const double least = __longlong_as_double(static_cast<long long>(nearest)),
                 largest = __longlong_as_double(static_cast<long long>(farthest));
    const double half = least + 0.5 * (largest - least);
    __syncthreads();
    if (found > kThreads && half < largest) {
      limit = half;
      continue;
    }
    const int sorted = static_cast<int>(min(found, static_cast<unsigned>(kThreads)));
    if (thread < sorted) {
      const double middle = segments[thread].middle();
      int before = 0;
      for (int other = 0; other < sorted; ++other) {
        const double at = segments[other].middle();
        before += at < middle || (at == middle && other < thread) ? 1 : 0;
      }
      order[before] = thread;
    }
    __syncthreads();
    if (thread == 0) {
      for (int n = 0; n < sorted && integral.through() >= task.through; ++n)
        addSegment(segments[order[n]], ray, integral);
      is_done = limit == HUGE_VAL || integral.through() < task.through;
    }
    __syncthreads();
    behind = limit;
    limit = HUGE_VAL;
    if (is_done) break;
  } while (true);
  if (thread == 0) picture[pixel] = integral.color();
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

long long TileProjector::raiseHidden(const MeshOnDevice& mesh, cudaStream_t stream) {
  // Only chains of cells whose centroids are in the wrong order need several sweeps; a cycle never ends.
  constexpr int kSweeps = 1024, kSweepsPerCheck = 16;
  unsigned raised = 0;
  raised_.resize(1);
  for (int sweep = 1; sweep <= kSweeps; ++sweep) {
    const bool is_checked = sweep % kSweepsPerCheck == 0;
    if (is_checked) check(cudaMemsetAsync(raised_.data(), 0, sizeof raised, stream), "cudaMemsetAsync");
    raiseNeighbours<<<blocksFor(mesh.cells), kThreads, 0, stream>>>(
        mesh.view, mesh.cells, behind_.data(), keys_.from.data(), is_checked ? raised_.data() : nullptr);
    checkLaunch("raiseNeighbours");
    if (!is_checked) continue;
    raised_.download(&raised, stream);
    if (raised == 0) break;
  }
  return raised;
}

long long TileProjector::sort(const TileTask& task, const MeshOnDevice& mesh, CellSorting sorting,
                              cudaStream_t stream) {
  const auto count = static_cast<std::size_t>(mesh.cells);
  const bool by_visibility = sorting == CellSorting::visibility;
  for (auto* keys : {&keys_.from, &keys_.to}) keys->atLeast(count);
  for (auto* order : {&order_.from, &order_.to}) order->atLeast(count);
  if (by_visibility) behind_.atLeast(count);
  findKeys<<<blocksFor(mesh.cells), kThreads, 0, stream>>>(task, mesh.view, mesh.cells, keys_.from.data(),
                                                           order_.from.data(),
                                                           by_visibility ? behind_.data() : nullptr);
  checkLaunch("findKeys");
  const long long cycles = by_visibility ? raiseHidden(mesh, stream) : 0;
  withTemporary(temporary_, "cub::DeviceRadixSort of cells", [&](void* temporary, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairsDescending(temporary, bytes, keys_.from.data(), keys_.to.data(),
                                                     order_.from.data(), order_.to.data(), mesh.cells, 0, 32,
                                                     stream);
  });
  return cycles;
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

void TileProjector::composite(const TileTask& task, const int* ranks, bool sort_rays, cudaStream_t stream) {
  const auto tiles = static_cast<unsigned>(TileGrid{task.camera.size}.count());
  if (!sort_rays) {
    compositeTiles<false><<<tiles, kThreads, 0, stream>>>(task, ranks, first_.data(), {}, picture_.data());
    checkLaunch("compositeTiles");
    return;
  }
  wrong_count_.resize(1);
  check(cudaMemsetAsync(wrong_count_.data(), 0, sizeof(unsigned), stream), "cudaMemsetAsync");
  const WrongPixels wrong{wrong_count_.data(), wrong_.atLeast(picture_.size())};
  compositeTiles<true><<<tiles, kThreads, 0, stream>>>(task, ranks, first_.data(), wrong, picture_.data());
  checkLaunch("compositeTiles");
  unsigned count = 0;
  wrong_count_.download(&count, stream);
  if (count == 0) return;
  compositeSorted<<<count, kThreads, 0, stream>>>(task, ranks, first_.data(), wrong_.data(), picture_.data());
  checkLaunch("compositeSorted");
}

TileTimes TileProjector::project(TileTask task, const MeshOnDevice& mesh, CellSorting sorting, Image& image,
                                 cudaStream_t stream) {
  begin_.record(stream);
  const long long cycles = sort(task, mesh, sorting, stream);
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
      task, mesh.view, mesh.cells, order_.to.data(), cells_.data(), tile_counts_.from.data(), drawn_.data());
  checkLaunch("placeCells");
  const int* const ranks = bin(task, mesh, stream);
  binned_.record(stream);

  const ImageSize size = task.camera.size;
  picture_.resize(static_cast<std::size_t>(size.count()));
  composite(task, ranks, sorting == CellSorting::visibility, stream);
  drawn_mark_.record(stream);
  image = Image(size);
  picture_.download(image.pixels.data(), stream);
  unsigned long long drawn = 0;
  drawn_.download(&drawn, stream);
  return {ordered_.since_ms(begin_), binned_.since_ms(ordered_), drawn_mark_.since_ms(binned_),
          static_cast<long long>(drawn), cycles};
}

}  // namespace emscape::render
