/// The march of the parabolic equation over all azimuths around an emitter on a GPU, with one block of
/// threads per azimuth.
#pragma once

#include <cuda_runtime_api.h>

#include <vector>

#include "base/cuda/cuda_memory.h"
#include "propagation/parabolic_equation/march/march_block_input.h"

namespace emscape::propagation {

/// Device memory of a march, for one emitter after another. For one thread at a time.
class AzimuthMarchCuda {
 public:
  /// Starts a march. The previous one may still be in progress, if it is on the same stream.
  /// @param excess_db  device memory, march.cellCount() elements; written as by marchAzimuths()
  /// @param columns_at  steps whose columns are kept; see columnsOnGpu()
  /// @throws Error as marchAzimuthsOnGpu()
  void start(const AzimuthMarch& march, float* excess_db, cudaStream_t stream,
             const std::vector<int>& columns_at = {});
  /// @param input  blockInput() of the march and the columns
  void start(const AzimuthMarch& march, BlockInput input, float* excess_db, cudaStream_t stream,
             const std::vector<int>& columns_at = {});
  std::vector<FieldColumn> columns();
  std::size_t bytes() const;

 private:
  template <class Shape>
  void launch(MarchBlockTask task, cudaStream_t stream);

  BlockInput input_;
  MarchGrid grid_;
  int azimuths_ = 0;
  std::vector<int> columns_at_;
  cudaStream_t stream_ = nullptr;
  cuda::Buffer<AirSegment> segments_;
  cuda::Buffer<AirLevel> levels_;
  cuda::Buffer<int> first_segment_, cell_end_, counts_, column_steps_, column_intervals_;
  cuda::Buffer<float> ground_, sums_, amplitudes_;
  cuda::Buffer<double> column_ground_;
  cuda::Buffer<StoredComplex> start_, fields_, tables_;
  cuda::Buffer<MarchState> states_;
  cuda::Buffer<PlannedStep> planned_;
};

}  // namespace emscape::propagation
