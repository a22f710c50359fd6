#include "emfield/cpu/both_rays.h"

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// Row of an emitter with weighted reflected rays.
/// @param reflected  of the row's first voxel
template <PatternKind kind>
__attribute__((always_inline)) inline void fillBothRays(const EmitterBeam& emitter,
                                                        const ReflectedRayCode* reflected, const Row& row,
                                                        float* out) {
  const EmitterBeam local = emitter;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    out[i] = powerDensity_wm2<kind>(local, reflected[i], row.column + i, row.t_m);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void rowOfKind(const EmitterBeam& emitter, const ReflectedRayCode* reflected,
                                   const Row& row, float* out) {
  fillBothRays<kind>(emitter, reflected, row, out);
}

}  // namespace

void bothRaysRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected, const Row& row, float* out) {
  onPattern(emitter.pattern, [&](auto kind) { rowOfKind<kind>(emitter, reflected, row, out); });
}

}  // namespace emscape::emfield
