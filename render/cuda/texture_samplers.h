/// Samples of a volume in a GPU's texture memory, for RaycastTask.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "render/cast/volume_view.h"
#include "volume/sparse/sparse_tiles.h"

namespace emscape::render::cuda {

/// The texel at a position counted in voxels from the corner of the first one.
EMSCAPE_HD inline float texelAt([[maybe_unused]] std::uint64_t texture, [[maybe_unused]] float x,
                                [[maybe_unused]] float y, [[maybe_unused]] float z) {
#if defined(__CUDA_ARCH__)
  return tex3D<float>(texture, x, y, z);
#else
  return NAN;  // never called: the host has no such memory
#endif
}

/// Trilinear interpolation by the texture unit, with fractions of 8 bits. VolumeView::texture filters.
struct FilteredSampler : SamplerOf<FilteredSampler> {
  static constexpr float kShift = 0.5F;  // texels are counted from the corner of the first one
  EMSCAPE_HD static float fetch(const VolumeView& volume, const Vec3f& texel) {
    return texelAt(volume.texture, texel.x, texel.y, texel.z);
  }
};

/// Single voxels. VolumeView::texture does not filter.
struct TextureVoxels {
  const VolumeView& volume;
  EMSCAPE_HD explicit TextureVoxels(const VolumeView& of) : volume(of) {}
  EMSCAPE_HD float at(int i, int j, int k) const {
    return texelAt(volume.texture, static_cast<float>(i) + 0.5F, static_cast<float>(j) + 0.5F,
                   static_cast<float>(k) + 0.5F);
  }
};
using AccurateSampler = TrilinearSamplerOf<TextureVoxels>;
using NearestTextureSampler = NearestSamplerOf<TextureVoxels>;

/// Single voxels of a sparse volume. VolumeView::texture does not filter.
struct TileVoxels {
  const VolumeView& volume;
  volume::SparseTiles tiles;
  EMSCAPE_HD explicit TileVoxels(const VolumeView& of) : volume(of), tiles(of.tiles, of.dims) {}
  EMSCAPE_HD float at(int i, int j, int k) const {
    const volume::SparseTile tile = tiles.at(i, j, k);
    if (tile.place == volume::SparseTile::kNone) return tile.constant;
    const auto texel = [&](int axis, int voxel) {
      return static_cast<float>(volume::SparseTiles::firstTexel(tile.place, axis) +
                                volume::SparseTiles::inBlock(voxel)) +
             0.5F;
    };
    return texelAt(volume.texture, texel(0, i), texel(1, j), texel(2, k));
  }
};
using AccurateTileSampler = TrilinearSamplerOf<TileVoxels>;
using NearestTileSampler = NearestSamplerOf<TileVoxels>;

/// As FilteredSampler, within a tile of a sparse volume.
struct FilteredTileSampler : SamplerOf<FilteredTileSampler> {
  EMSCAPE_HD static float fetch(const VolumeView& volume, const Vec3f& position) {
    const CellPosition x(position.x, volume.dims.x);
    const CellPosition y(position.y, volume.dims.y);
    const CellPosition z(position.z, volume.dims.z);
    const volume::SparseTile tile = volume::SparseTiles(volume.tiles, volume.dims).at(x.low, y.low, z.low);
    if (tile.place == volume::SparseTile::kNone) return tile.constant;
    const auto texel = [&](int axis, const CellPosition& cell) {
      return static_cast<float>(volume::SparseTiles::firstTexel(tile.place, axis) +
                                volume::SparseTiles::inBlock(cell.low)) +
             cell.fraction + 0.5F;
    };
    return texelAt(volume.texture, texel(0, x), texel(1, y), texel(2, z));
  }
};

}  // namespace emscape::render::cuda
