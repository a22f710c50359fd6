/// A regular grid of voxels in a local frame.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/vec.h"

namespace emscape::volume {

/// Voxel (i, j, k) has its centre at first_center_m + (i, j, k) * spacing_m in the frame of `frame`, which
/// defines its position on the earth. Dense order everywhere: x fastest, then y, then z.
struct Grid {
  Dims dims;
  Vec3d spacing_m;
  Vec3d first_center_m;
  FrameOrigin frame;
  /// False for a volume without a position on the earth (a scan, a raw file): frame is then undefined.
  bool georeferenced = false;

  long long index(int i, int j, int k) const { return (static_cast<long long>(k) * dims.y + j) * dims.x + i; }
  Vec3d center_m(int i, int j, int k) const {
    return {first_center_m.x + i * spacing_m.x, first_center_m.y + j * spacing_m.y,
            first_center_m.z + k * spacing_m.z};
  }
  /// Corners of the box of the voxels (half a voxel beyond the outer centres).
  Vec3d lower_m() const { return first_center_m - spacing_m * 0.5; }
  Vec3d upper_m() const {
    return lower_m() + Vec3d{spacing_m.x * dims.x, spacing_m.y * dims.y, spacing_m.z * dims.z};
  }
};

/// The frame of a grid or mesh, and what its values without a field are, in the words of other programs: keys
/// and texts that every file has beside our own, the same in all formats (docs/volume-files.md). crs_wkt,
/// vertical_datum, axes only with a position on the earth.
std::vector<std::pair<std::string, std::string>> standardWords(bool georeferenced, const FrameOrigin& frame);

bool operator==(const Grid& a, const Grid& b);
inline bool operator!=(const Grid& a, const Grid& b) {
  return !(a == b);
}

}  // namespace emscape::volume
