/// Rows of a look's weights without reflected rays, for the loops of radars.
#pragma once

#include "emfield/combine/radar_product.h"
#include "emfield/cpu/row.h"

namespace emscape::emfield {

/// @param jammer  null: the echo's weights, without the excess
template <scenario::PatternKind kind>
__attribute__((always_inline)) inline void fillWeights(const RadarPass& pass, const JammerAtRadar* jammer,
                                                       const Row& row, float* out) {
  const RadarLook look = pass.task.look;
  const EmitterBeam beam = pass.beam;
  if (jammer == nullptr) {
#pragma omp simd
    for (int i = 0; i < row.count; ++i) out[i] = echoWeight<kind>(look, beam, row.column + i, row.t_m);
  } else {
    const JammerAtRadar local = *jammer;
#pragma omp simd
    for (int i = 0; i < row.count; ++i)
      out[i] = jammingWeight<kind>(look, beam, local, row.column + i, row.t_m);
  }
}

}  // namespace emscape::emfield
