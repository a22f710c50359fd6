/// Losses over a column's heights from as few evaluations of a model as their course allows.
#pragma once

#include <cmath>

#include "base/host_device.h"

namespace emscape::emfield {

/// Evaluates a function at some indices of 0..count - 1 and draws straight lines between them: every
/// kCoarsest indices, and wherever half way between two evaluations it leaves their line by more than a
/// tolerance, or where it is so steep that a bend may hide beside the middle.
/// @param evaluate  double or float of an index; called no more than once for each
/// @param out       `count` values
template <class Evaluate>
EMSCAPE_HD void fillByBisection(Evaluate evaluate, int count, float tolerance_db, float* out) {
  constexpr int kCoarsest = 16;
  constexpr int kDeepest = 8;
  constexpr float kSteep_db = 3;
  if (count <= 0) return;
  const auto drawLine = [out](int begin, int end) {
    for (int i = begin + 1; i < end; ++i) {
      const float part = static_cast<float>(i - begin) / static_cast<float>(end - begin);
      out[i] = out[begin] + part * (out[end] - out[begin]);
    }
  };
  out[0] = evaluate(0);
  for (int begin = 0; begin < count - 1; begin += kCoarsest) {
    const int stop = begin + kCoarsest < count - 1 ? begin + kCoarsest : count - 1;
    out[stop] = evaluate(stop);
    // ends of the pieces still to do, the nearest last
    int ends[kDeepest];
    int waiting = 0;
    ends[waiting++] = stop;
    int from = begin;
    while (waiting > 0) {
      const int to = ends[waiting - 1];
      if (to - from < 2) {
        from = to;
        --waiting;
        continue;
      }
      const int middle = (from + to) / 2;
      const float part = static_cast<float>(middle - from) / static_cast<float>(to - from);
      const float line = out[from] + part * (out[to] - out[from]);
      out[middle] = evaluate(middle);
      if (std::fabs(out[middle] - line) <= tolerance_db && std::fabs(out[to] - out[from]) <= kSteep_db) {
        drawLine(from, middle);
        drawLine(middle, to);
        from = to;
        --waiting;
      } else {
        ends[waiting++] = middle;
      }
    }
  }
}

}  // namespace emscape::emfield
