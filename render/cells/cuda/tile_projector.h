/// Cell projection by tiles of pixels, by CUDA.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/cuda/cuda_memory.h"
#include "render/cells/cell_caster.h"

namespace emscape::render {

/// A mesh in device memory.
struct MeshOnDevice {
  CellMeshView view;
  int points, cells;
};

class TileProjector {
 public:
  /// @param task   without points and cells; its other pointers are to device memory
  /// @throws Error (device)
  TileTimes project(TileTask task, const MeshOnDevice& mesh, CellSorting sorting, Image& image,
                    cudaStream_t stream);

 private:
  /// Sorts all cells into order_.to, the farthest first. @return CellOrder::cycles
  long long sort(const TileTask& task, const MeshOnDevice& mesh, CellSorting sorting, cudaStream_t stream);
  /// Raises the keys of hidden cells above the keys of those that hide them. @return CellOrder::cycles
  long long raiseHidden(const MeshOnDevice& mesh, cudaStream_t stream);
  /// Ranks of cells by the tiles that they touch, ascending in each; the first of each tile is in first_.
  const int* bin(const TileTask& task, const MeshOnDevice& mesh, cudaStream_t stream);
  /// Composites the tiles into picture_.
  /// @param sort_rays  see TileProjection
  void composite(const TileTask& task, const int* ranks, bool sort_rays, cudaStream_t stream);

  template <class T>
  using Buffer = emscape::cuda::Buffer<T>;
  /// Input and output buffers of a sort.
  template <class T>
  struct Pair {
    Buffer<T> from, to;
  };
  Buffer<ViewPoint> points_;
  Buffer<PlacedCell> cells_;
  Pair<std::uint32_t> keys_;
  Buffer<std::uint8_t> behind_;
  Buffer<unsigned> raised_;
  Pair<std::int32_t> order_;
  Pair<unsigned> tile_counts_;  ///< of the cells; then the sums before each
  Pair<unsigned> tiles_;
  Pair<int> ranks_;
  Buffer<unsigned> first_;
  Buffer<unsigned long long> drawn_;
  Buffer<std::byte> temporary_;
  Buffer<Rgba> picture_;
  Buffer<unsigned> wrong_count_;
  Buffer<int> wrong_;  ///< pixels whose rays met cells in the wrong order
  emscape::cuda::TimeMark begin_, ordered_, binned_, drawn_mark_;
};

}  // namespace emscape::render
