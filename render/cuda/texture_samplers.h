/// Samples of a volume in a GPU's texture memory, for RaycastTask.
#pragma once

#include "base/host_device.h"
#include "base/vec.h"
#include "render/volume_view.h"

namespace emscape::render::cuda {

/// The texel at a position counted in voxels from the corner of the first one.
EMSCAPE_HD inline float texelAt([[maybe_unused]] std::uint64_t texture, [[maybe_unused]] float x,
                                [[maybe_unused]] float y, [[maybe_unused]] float z) {
#if defined(__CUDA_ARCH__)
  return tex3D<float>(texture, x, y, z);
#else
  return NAN;  // never called: there is no such memory on the host
#endif
}

/// Trilinear as the texture unit does it: fractions of 8 bits. VolumeView::texture filters.
struct FilteredSampler {
  EMSCAPE_HD static bool sample(const VolumeView& volume, const Vec3f& position, float& value) {
    if (position.z < static_cast<float>(volume.masked_below)) {
      const CellPosition x(position.x, volume.dims.x);
      const CellPosition y(position.y, volume.dims.y);
      const CellPosition z(position.z, volume.dims.z);
      if (volume.isMasked(x.nearest(), y.nearest(), z.nearest())) return false;
    }
    value = texelAt(volume.texture, position.x + 0.5F, position.y + 0.5F, position.z + 0.5F);
    return value == value;
  }
};

/// Single voxels. VolumeView::texture does not filter.
struct TextureVoxels {
  EMSCAPE_HD static float at(const VolumeView& volume, int i, int j, int k) {
    return texelAt(volume.texture, static_cast<float>(i) + 0.5F, static_cast<float>(j) + 0.5F,
                   static_cast<float>(k) + 0.5F);
  }
};
using AccurateSampler = TrilinearSamplerOf<TextureVoxels>;
using NearestTextureSampler = NearestSamplerOf<TextureVoxels>;

}  // namespace emscape::render::cuda
