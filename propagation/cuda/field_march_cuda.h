/// All marches of an emitter's field on a GPU; the losses stay in its memory.
#pragma once

#include <vector>

#include "propagation/cuda/march_cuda.h"
#include "propagation/parabolic_equation/field_march.h"

namespace emscape::propagation {

/// Device memory of the marches, for one emitter after another on the same stream. For one thread at a time.
class FieldMarchCuda {
 public:
  /// Initial data of the marches, each member's polarisations one after another; takes milliseconds on the
  /// host.
  /// @throws Error as marchAzimuthsOnGpu()
  static std::vector<BlockInput> inputs(FieldMarch& field);

  /// Starts the marches of marchField(); the results agree with it as those of marchAzimuthsOnGpu() with
  /// marchAzimuths().
  /// @param field   isForGpu(); may change after the call
  /// @param inputs  of the field
  /// @return field.cellCount() losses in device memory, until the next start()
  /// @throws Error as marchAzimuthsOnGpu()
  const float* start(FieldMarch& field, std::vector<BlockInput> inputs, cudaStream_t stream);
  std::size_t bytes() const;

 private:
  AzimuthMarchCuda march_;
  /// Losses of the members one after another, then of the second polarisation, or of the ensemble.
  cuda::Buffer<float> losses_db_;
  cuda::Buffer<int> known_ranges_;
};

}  // namespace emscape::propagation
