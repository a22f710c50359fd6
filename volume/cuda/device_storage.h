/// The storage of a DeviceVolume, for kernels that write and read it. For .cu files and the .cpp files next
/// to them.
#pragma once

#include <cuda_fp16.h>
#include <cuda_runtime_api.h>

#include <mutex>

#include "base/cuda/cuda_memory.h"
#include "emscape/volume/device_volume.h"
#include "volume/bricks.h"
#include "volume/sparse/sparse_tiles.h"

#if defined(__CUDACC__)
#include <surface_indirect_functions.h>
#endif

namespace emscape::volume {

/// Voxels for kernels to write. Each masked voxel takes the value of the first unmasked voxel above it.
struct VoxelWriter {
  cudaSurfaceObject_t surface = 0;
  Dims dims;
  VoxelPrecision precision = VoxelPrecision::float32;

#if defined(__CUDACC__)
  __device__ void write(int i, int j, int k, float value) const {
    if (precision == VoxelPrecision::float32) {
      surf3Dwrite(value, surface, i * static_cast<int>(sizeof value), j, k);
    } else {
      const unsigned short bits = __half_as_ushort(__float2half_rn(value));
      surf3Dwrite(bits, surface, i * static_cast<int>(sizeof bits), j, k);
    }
  }
  __device__ float read(int i, int j, int k) const {
    if (precision == VoxelPrecision::float32) {
      return surf3Dread<float>(surface, i * static_cast<int>(sizeof(float)), j, k);
    }
    return __half2float(__ushort_as_half(surf3Dread<unsigned short>(surface, i * 2, j, k)));
  }
#endif
};

/// The memory of a DeviceVolume, and the order of its readers and writers. The calls below only order work on
/// streams and do not wait. Several threads may read at a time; one thread writes.
class DeviceStorage {
 public:
  /// @throws Error (device) that names the bytes needed and free
  DeviceStorage(const Dims& dims, VoxelPrecision precision);
  ~DeviceStorage();
  DeviceStorage(const DeviceStorage&) = delete;
  DeviceStorage& operator=(const DeviceStorage&) = delete;

  /// Kernels launched on the stream after this call may write: they wait for readers. Kernels write every
  /// voxel, including masked ones, but no voxel of a sparse volume.
  VoxelWriter beginWriting(cudaStream_t stream);
  /// Called after the launch of all writing kernels: computes the bricks; then readers may begin.
  void endWriting(cudaStream_t stream);

  /// Kernels launched on the stream after this call may read: they wait for the writer.
  void beginReading(cudaStream_t stream) const;
  void endReading(cudaStream_t stream) const;

  /// Of the voxels, or of the atlas of a sparse volume. Positions are those of centres plus 0.5; beyond the
  /// outer centres of voxels their values are repeated.
  cudaTextureObject_t linearTexture() const {
    return linear_;
  }  ///< interpolated by the GPU, with 8-bit fractions
  cudaTextureObject_t pointTexture() const { return point_; }
  /// In device memory; computed by endWriting().
  BricksView bricks() const;
  /// In device memory; null unless the volume is sparse.
  const SparseTile* sparseTiles() const { return sparse_tiles_.data(); }
  std::size_t sparseBytes() const;
  /// In device memory, one per column; null if no voxel is masked.
  const std::int32_t* firstValidK() const { return masked_below_ > 0 ? first_valid_k_.data() : nullptr; }
  int maskedBelow() const { return masked_below_; }

  /// Waits for readers. @param first_valid_k  one per column, or none
  void setMask(const std::vector<std::uint16_t>& first_valid_k);
  /// Writes all voxels on the stream, from values in dense order; masked values are not read.
  void writeFrom(const float* host_values, cudaStream_t stream);
  /// Replaces all voxels of a sparse volume, on the stream. @param grid  as returned by readyForSampling()
  /// @throws Error (device) that names the bytes needed and free
  void setSparse(const std::uint8_t* grid, std::size_t bytes, cudaStream_t stream);
  /// Copies to host memory and waits for the stream. Masked voxels get the floor.
  void readTo(float* host_values, float floor, cudaStream_t stream) const;
  /// The same into device memory; does not wait.
  void copyTo(float* device_values, float floor, cudaStream_t stream) const;

 private:
  template <class Use>
  void withSource(const Use& use) const;
  void loadLayers(int begin_k, int end_k, float floor, float* values, cudaStream_t stream) const;
  void allocate();
  void allocateTexels(const cudaChannelFormatDesc& format, const Dims& dims);
  cudaTextureObject_t makeTexture(cudaTextureFilterMode filter) const;
  void release();
  VoxelWriter voxels() const { return {surface_, dims_, precision_}; }
  int slabLayers() const;

  Dims dims_;
  VoxelPrecision precision_;
  cudaArray_t array_ = nullptr;
  cudaSurfaceObject_t surface_ = 0;
  cudaTextureObject_t linear_ = 0, point_ = 0;
  emscape::cuda::Buffer<SparseTile> sparse_tiles_;
  Dims atlas_dims_;  ///< tiles along each axis of the atlas
  emscape::cuda::Buffer<std::int32_t> first_valid_k_;
  int masked_below_ = 0;
  Dims brick_dims_;
  emscape::cuda::Buffer<ValueRange> bricks_;
  mutable std::mutex order_;  ///< of the events below
  emscape::cuda::Event written_;
  mutable emscape::cuda::Event read_;
};

}  // namespace emscape::volume
