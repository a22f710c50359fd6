#include "base/math/simd.h"
#include "emfield/cpu/both_rays.h"
#include "emfield/cpu/echo_rows.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// @param jammer     null: the echo's weights
/// @param reflected  of the row's first voxel; null: the radar's reflected rays are not weighted
template <PatternKind kind>
__attribute__((always_inline)) inline void fillWeightsOfBothRays(const RadarPass& pass,
                                                                 const JammerAtRadar* jammer,
                                                                 const ReflectedRayCode* reflected,
                                                                 const Row& row, float* out) {
  const RadarLook look = pass.task.look;
  const EmitterBeam beam = pass.beam;
  if (jammer == nullptr && kind != PatternKind::isotropic && reflected != nullptr) {
#pragma omp simd
    for (int i = 0; i < row.count; ++i)
      out[i] = echoWeight<kind>(look, beam, reflected[i], row.column + i, row.t_m);
  } else if (jammer != nullptr && jammer->has_reflected_ray) {
    const JammerAtRadar local = *jammer;
#pragma omp simd
    for (int i = 0; i < row.count; ++i)
      out[i] = jammingWeightOfBothRays<kind>(look, beam, local, row.column + i, row.t_m);
  } else {
    fillWeights<kind>(pass, jammer, row, out);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void weightsOfKind(const RadarPass& pass, const JammerAtRadar* jammer,
                                       const ReflectedRayCode* reflected, const Row& row, float* out) {
  fillWeightsOfBothRays<kind>(pass, jammer, reflected, row, out);
}

}  // namespace

void weightsOfBothRays(const RadarPass& pass, const JammerAtRadar* jammer, std::size_t voxel, const Row& row,
                       float* out) {
  const ReflectedRayCode* const reflected =
      weighsReflectedRays(pass.beam) ? pass.beam.geometry.reflected + voxel : nullptr;
  onPattern(pass.beam.pattern, [&](auto kind) { weightsOfKind<kind>(pass, jammer, reflected, row, out); });
}

}  // namespace emscape::emfield
