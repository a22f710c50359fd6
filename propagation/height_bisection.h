/// Losses over a column's heights by adaptive bisection, with few evaluations of a model.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// Number of indices between evaluations that are always made; values between two of these depend only on the
/// two.
constexpr int kBisectionStep = 16;

/// Values between two indices, on a line.
EMSCAPE_HD inline void drawLine(float* out, int begin, int end) {
  for (int i = begin + 1; i < end; ++i) {
    const float part = static_cast<float>(i - begin) / static_cast<float>(end - begin);
    out[i] = out[begin] + part * (out[end] - out[begin]);
  }
}
/// True if the values on either side of `middle` may be taken from lines.
EMSCAPE_HD inline bool isStraight(const float* out, int begin, int middle, int end, float tolerance_db) {
  constexpr float kSteep_db = 3;
  const float part = static_cast<float>(middle - begin) / static_cast<float>(end - begin);
  const float line = out[begin] + part * (out[end] - out[begin]);
  return std::fabs(out[middle] - line) <= tolerance_db && std::fabs(out[end] - out[begin]) <= kSteep_db;
}

/// Evaluates a function at some indices of 0..count - 1 and interpolates linearly between them. It is
/// evaluated every kBisectionStep indices, at the last one, and between two evaluations if the value half way
/// differs from their line by more than a tolerance, or if the slope is so large that a bend may be missed.
/// @param tolerance_db  negative: every index is evaluated
/// @param evaluate  double or float of an index; called at most once for each
/// @param out       `count` values
template <class Evaluate>
EMSCAPE_HD void fillByBisection(Evaluate evaluate, int count, float tolerance_db, float* out) {
  constexpr int kDeepest = 8;
  if (count <= 0) return;
  // One call site only, so that the threads of a GPU's warp call the function together.
  int ends[kDeepest];  // of the pending intervals, the nearest last
  int waiting = 0, from = 0, at = 0;
  bool is_middle = false;
  for (;;) {
    out[at] = evaluate(at);
    if (is_middle && isStraight(out, from, at, ends[waiting - 1], tolerance_db)) {
      drawLine(out, from, at);
      drawLine(out, at, ends[waiting - 1]);
      from = ends[--waiting];
    } else {
      ends[waiting++] = at;
    }
    while (waiting > 0 && ends[waiting - 1] - from < 2) from = ends[--waiting];
    is_middle = waiting > 0;
    if (is_middle) {
      at = (from + ends[waiting - 1]) / 2;
    } else {
      if (from == count - 1) return;
      at = from + kBisectionStep < count - 1 ? from + kBisectionStep : count - 1;
    }
  }
}

}  // namespace emscape::propagation
