#include "emfield/cpu/both_rays.h"

#include <algorithm>

#include "base/simd.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// Row of an emitter whose reflected rays are weighed.
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

template <PatternKind kind>
__attribute__((always_inline)) inline void fillEchoes(const RadarPass& pass, const Row& row, float* root) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    root[i] = echoToNoiseRoot<kind>(task, beam, row.column + i, row.t_m);
  }
}

/// @param reflected  of the row's first voxel
template <PatternKind kind>
__attribute__((always_inline)) inline void fillEchoesOfBothRays(const RadarPass& pass,
                                                                const ReflectedRayCode* reflected,
                                                                const Row& row, float* root) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    root[i] = echoToNoiseRoot<kind>(task, beam, reflected[i], row.column + i, row.t_m);
  }
}

template <PatternKind kind>
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

template <PatternKind kind>
__attribute__((always_inline)) inline void addJammingOfBothRays(const RadarPass& pass,
                                                                const JammerAtRadar& jammer, const Row& row,
                                                                float* jamming) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
  const JammerAtRadar local = jammer;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    jamming[i] += jammingOfBothRaysToNoise<kind>(task, beam, local, row.column + i, row.t_m);
  }
}

/// @param reflected  of the row's first voxel; null: the radar's reflected rays are not weighed
template <PatternKind kind>
__attribute__((always_inline)) inline void fillRowOfBothRays(const RadarPass& pass,
                                                             const ReflectedRayCode* reflected,
                                                             const Row& row, float* root, float* jamming) {
  if (kind != PatternKind::isotropic && reflected != nullptr) {
    fillEchoesOfBothRays<kind>(pass, reflected, row, root);
  } else {
    fillEchoes<kind>(pass, row, root);
  }
  std::fill_n(jamming, row.count, 0.0f);
  for (int n = 0; n < pass.task.jammer_count; ++n) {
    const JammerAtRadar& jammer = pass.task.jammers[n];
    if (jammer.has_reflected_ray) {
      addJammingOfBothRays<kind>(pass, jammer, row, jamming);
    } else {
      addJamming<kind>(pass, jammer, row, jamming);
    }
  }
}

EMSCAPE_SIMD_CLONES void isotropicEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                         const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::isotropic>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gaussianEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                        const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::gaussian>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void separableEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                         const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::separable>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void phasedArrayEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                           const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::phased_array>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gridEchoes(const RadarPass& pass, const ReflectedRayCode* reflected, const Row& row,
                                    float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::grid>(pass, reflected, row, root, jamming);
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

void echoesOfBothRays(const RadarPass& pass, std::size_t voxel, const Row& row, float* root, float* jamming) {
  const ReflectedRayCode* const reflected =
      weighsReflectedRays(pass.beam) ? pass.beam.geometry.reflected + voxel : nullptr;
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return isotropicEchoes(pass, reflected, row, root, jamming);
    case PatternKind::gaussian:
      return gaussianEchoes(pass, reflected, row, root, jamming);
    case PatternKind::separable:
      return separableEchoes(pass, reflected, row, root, jamming);
    case PatternKind::phased_array:
      return phasedArrayEchoes(pass, reflected, row, root, jamming);
    case PatternKind::grid:
      return gridEchoes(pass, reflected, row, root, jamming);
  }
}

}  // namespace emscape::emfield
