/// All marches of an emitter's field on a GPU; the losses stay there.
#pragma once

#include <vector>

#include "propagation/cuda/march_cuda.h"
#include "propagation/parabolic_equation/field_march.h"

namespace emscape::propagation {

/// Device memory of the marches, for one emitter after the other on the same stream. Not for several threads
/// at once.
class FieldMarchCuda {
 public:
  /// What the marches begin with, each member's polarisations one after another: milliseconds of the host.
  /// @throws Error as marchAzimuthsOnGpu()
  static std::vector<BlockInput> inputs(FieldMarch& field);

  /// Starts the marches of marchField(); they agree with it as marchAzimuthsOnGpu() with marchAzimuths().
  /// @param field   isForGpu(); may change after the call
  /// @param inputs  of the field
  /// @param warnings  device memory; the bits that marchField() returns are added at the end
  /// @return field.cellCount() losses in device memory, until the next start()
  /// @throws Error as marchAzimuthsOnGpu()
  const float* start(FieldMarch& field, std::vector<BlockInput> inputs, unsigned* warnings,
                     cudaStream_t stream);
  std::size_t bytes() const;

 private:
  AzimuthMarchCuda march_;
  /// Of the members one after another, then of the second polarisation, or the ensemble's.
  cuda::Buffer<float> losses_db_;
  cuda::Buffer<int> known_ranges_;
};

}  // namespace emscape::propagation
