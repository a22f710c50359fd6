/// A scalar field on a grid, in the memory of a GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/volume/dense_volume.h"
#include "emscape/volume/grid.h"

namespace emscape::volume {

/// Storage of voxels on a GPU.
enum class VoxelPrecision {
  float32,
  float16,  ///< half the memory; 11 significant bits, -65504..65504
  sparse32  ///< blocks without those of voxels at the floor; written only by upload()
};

/// Memory of the GPU for a volume of these dims, derived data included. For sparse volumes it is a lower
/// bound; the rest depends on the values.
std::size_t deviceBytes(const Dims& dims, VoxelPrecision precision);

class DeviceStorage;  // volume/cuda/device_storage.h

/// Values in GPU memory, which kernels write and the ray caster samples. Masked voxels repeat the first value
/// above them that is not masked, so that interpolation near the ground does not blend in the floor;
/// uploading and downloading convert from and to the floor of DenseVolume.
///
/// Kernels access it through storage(), whose begin and end calls order writers and readers on their streams,
/// so that a picture never shows a partial update. A build without CUDA has the type but cannot construct it.
class DeviceVolume {
 public:
  /// Values are undefined until they are written.
  /// @throws Error (device) that names the bytes needed and free if they do not fit, or if there is no GPU
  explicit DeviceVolume(const Grid& grid, VoxelPrecision precision = VoxelPrecision::float32);
  ~DeviceVolume();

  const Grid& grid() const { return grid_; }
  VoxelPrecision precision() const { return precision_; }
  /// GPU memory that it uses (bytes).
  std::size_t bytes() const;

  /// Description of the values, set by the code that writes them.
  VolumeInfo info;

  /// Sets the first voxel with a field of each column, as in DenseVolume. Cheap if they do not change; else
  /// waits for readers. @throws Error (bad_input) unless there is one per column, or none at all
  void setMask(const std::vector<std::uint16_t>& first_valid_k);
  const std::vector<std::uint16_t>& firstValidK() const { return first_valid_k_; }

  /// Copies values, mask and info of a volume of the same dims. Returns when the copy is complete.
  /// @throws Error (bad_input) if the dims differ or the volume is malformed, (device) if a sparse one does
  /// not fit
  void upload(const DenseVolume& volume);
  /// A copy in host memory, for files. @throws Error (device)
  DenseVolume download() const;
  /// A copy in linear GPU memory of CUDA device 0, for kernels of other programs: in the order of
  /// DenseVolume, with the floor in masked voxels. Complete when the function returns.
  /// @throws Error (device)
  std::shared_ptr<const float> linearCopy() const;

  DeviceStorage& storage() { return *storage_; }
  const DeviceStorage& storage() const { return *storage_; }

 private:
  Grid grid_;
  VoxelPrecision precision_;
  std::vector<std::uint16_t> first_valid_k_;
  std::unique_ptr<DeviceStorage> storage_;
};

/// Ring of buffers: one is displayed while the next is written. For one thread; other threads may read the
/// volumes.
class DeviceVolumeRing {
 public:
  /// A volume of this grid that is not in use: one that was returned before and has been released, else a new
  /// one. @throws as DeviceVolume's constructor
  std::shared_ptr<DeviceVolume> next(const Grid& grid, VoxelPrecision precision);

 private:
  std::vector<std::shared_ptr<DeviceVolume>> volumes_;
};

}  // namespace emscape::volume
