/// Rows of echoes and of jamming without reflected rays, for the loops of radars.
#pragma once

#include "emfield/cpu/row.h"
#include "emfield/radar_product.h"

namespace emscape::emfield {

template <scenario::PatternKind kind>
__attribute__((always_inline)) inline void fillEchoes(const RadarPass& pass, const Row& row, float* root) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    root[i] = echoToNoiseRoot<kind>(task, beam, row.column + i, row.t_m);
  }
}

template <scenario::PatternKind kind>
__attribute__((always_inline)) inline void addJamming(const RadarPass& pass, const JammerAtRadar& jammer,
                                                      const Row& row, float* jamming) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
  const JammerAtRadar local = jammer;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    jamming[i] += jammingToNoise<kind>(task, beam, local, row.column + i, row.t_m);
  }
}

}  // namespace emscape::emfield
