/// Times of the field's stages on a stream, by events.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/cuda/cuda_memory.h"
#include "emscape/emfield/solver/field_solver.h"

namespace emscape::emfield::cuda {

/// Sums of the intervals of each stage. begin() and end() only record events on the stream; of several
/// begin() before an end() the last one counts.
class StageClock {
 public:
  using Stage = double StageTimes::*;

  void reset() {
    used_ = 0;
    marched_heights_ = 0;
  }
  void countMarch(double heights) { marched_heights_ += heights; }
  void begin(cudaStream_t stream) {
    if (used_ == timers_.size()) timers_.push_back(std::make_unique<Piece>());
    timers_[used_]->timer.begin(stream);
  }
  void end(Stage stage, cudaStream_t stream) {
    timers_[used_]->timer.end(stream);
    timers_[used_++]->stage = stage;
  }
  /// Waits for the last interval.
  StageTimes times() const {
    StageTimes times;
    times.marched_heights = marched_heights_;
    for (std::size_t i = 0; i < used_; ++i) times.*(timers_[i]->stage) += timers_[i]->timer.elapsed_ms();
    return times;
  }

 private:
  struct Piece {
    emscape::cuda::Timer timer;
    Stage stage = nullptr;
  };
  std::vector<std::unique_ptr<Piece>> timers_;
  std::size_t used_ = 0;
  double marched_heights_ = 0;
};

}  // namespace emscape::emfield::cuda
