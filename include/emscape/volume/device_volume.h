/// A scalar field on a grid, in the memory of a GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "emscape/volume/dense_volume.h"
#include "emscape/volume/grid.h"

namespace emscape::volume {

/// How a GPU keeps voxels.
enum class VoxelPrecision {
  float32,
  float16,  ///< half the memory; 11 significant bits, -65504..65504
  sparse32  ///< as a NanoVDB grid without what is at the floor; written by upload() alone
};

/// Memory of the GPU that a volume of these dims takes, what is derived from its values included. Of a sparse
/// one this is the least: the rest depends on its values.
std::size_t deviceBytes(const Dims& dims, VoxelPrecision precision);

class DeviceStorage;  // volume/cuda/device_storage.h

/// Values where a ray caster on the GPU samples them and where kernels write them. Masked voxels hold the
/// value of the first voxel above them that is not masked, so that nothing of what lies below the ground
/// reaches into the air; uploading and downloading translate from and to the floor of DenseVolume.
///
/// Kernels get at it through storage(), whose begin and end calls order writers and readers on their streams:
/// a picture never shows half an update. A build without CUDA has the type, but cannot make one.
class DeviceVolume {
 public:
  /// Values are undefined until they are written.
  /// @throws Error (device) that names the bytes needed and free if they do not fit, or if there is no GPU
  explicit DeviceVolume(const Grid& grid, VoxelPrecision precision = VoxelPrecision::float32);
  ~DeviceVolume();

  const Grid& grid() const { return grid_; }
  VoxelPrecision precision() const { return precision_; }
  /// Memory of the GPU that it takes.
  std::size_t bytes() const;

  /// What the values mean. Set by whoever writes them.
  VolumeInfo info;

  /// The columns' first voxels with a field, as in DenseVolume. Cheap where they stay the same; else waits
  /// for those who read. @throws Error (bad_input) unless there is one a column, or none at all
  void setMask(const std::vector<std::uint16_t>& first_valid_k);
  const std::vector<std::uint16_t>& firstValidK() const { return first_valid_k_; }

  /// Takes values, mask and info of a volume of the same dims. Returns when they are copied.
  /// @throws Error (bad_input) if the dims differ or the volume is malformed, (device) if a sparse one does
  /// not fit
  void upload(const DenseVolume& volume);
  /// A copy in the host's memory, for files. @throws Error (device)
  DenseVolume download() const;

  DeviceStorage& storage() { return *storage_; }
  const DeviceStorage& storage() const { return *storage_; }

 private:
  Grid grid_;
  VoxelPrecision precision_;
  std::vector<std::uint16_t> first_valid_k_;
  std::unique_ptr<DeviceStorage> storage_;
};

/// Volumes in turn: while one is shown the next is written. One thread uses it; the volumes may be read by
/// others.
class DeviceVolumeRing {
 public:
  /// A volume of this grid that nobody but the ring holds: one that was given before and let go since, else a
  /// new one. @throws as DeviceVolume's constructor
  std::shared_ptr<DeviceVolume> next(const Grid& grid, VoxelPrecision precision);

 private:
  std::vector<std::shared_ptr<DeviceVolume>> volumes_;
};

}  // namespace emscape::volume
