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

EMSCAPE_SIMD_CLONES void gaussianRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected,
                                     const Row& row, float* out) {
  fillBothRays<PatternKind::gaussian>(emitter, reflected, row, out);
}
EMSCAPE_SIMD_CLONES void separableRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected,
                                      const Row& row, float* out) {
  fillBothRays<PatternKind::separable>(emitter, reflected, row, out);
}
EMSCAPE_SIMD_CLONES void phasedArrayRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected,
                                        const Row& row, float* out) {
  fillBothRays<PatternKind::phased_array>(emitter, reflected, row, out);
}
EMSCAPE_SIMD_CLONES void gridRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected,
                                 const Row& row, float* out) {
  fillBothRays<PatternKind::grid>(emitter, reflected, row, out);
}

}  // namespace

void bothRaysRow(const EmitterBeam& emitter, const ReflectedRayCode* reflected, const Row& row, float* out) {
  switch (emitter.pattern.kind) {
    case PatternKind::isotropic:
      return;  // weighsReflectedRays() is false
    case PatternKind::gaussian:
      return gaussianRow(emitter, reflected, row, out);
    case PatternKind::separable:
      return separableRow(emitter, reflected, row, out);
    case PatternKind::phased_array:
      return phasedArrayRow(emitter, reflected, row, out);
    case PatternKind::grid:
      return gridRow(emitter, reflected, row, out);
  }
}

}  // namespace emscape::emfield
